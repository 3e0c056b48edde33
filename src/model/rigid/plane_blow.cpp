// Blows: what new points do to the bricks of a plane front, in no time.
#include <algorithm>
#include <cmath>

#include "model/rigid/plane_impulses.h"
#include "model/rigid/restitution.h"

namespace topple::rigid {

bool PlaneImpulses::closes_fast() const {
  const double slow = 0.5 * world_.gravity * world_.step;
  for (const int pair : state_.near_pairs) {
    const PlaneTouch& touch = state_.touch(pair);
    for (int k = 0; k < touch.now.count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (!touch.memory[at].fresh) continue;
      const PlanePoint& point = touch.now.points[at];
      const auto approach = [&](int place) {
        const PlaneBrick& brick = state_.brick(place);
        const Column<3> j = rate(touch.now.normal_x, touch.now.normal_z, point.x - brick.box.place.x, point.z - brick.box.place.z);
        return product_of(j, brick.velocity);
      };
      if ((touch.b < 0 ? 0.0 : approach(touch.b)) - approach(touch.a) > slow) return true;
    }
  }
  return false;
}

bool PlaneImpulses::take_blow(double whole, double next, BrickId struck) {
  const bool bounced = blow(false);
  for (PlaneBrick& brick : state_.bricks) {
    if (brick.moving) brick.acceleration = (2.0 / whole) * (brick.middle - brick.before_drift);
  }
  plan(next, !bounced, struck);
  for (const int pair : state_.near_pairs) state_.touch(pair).load = 0.0;
  if (!bounced) stop_at_once();
  return bounced;
}

// The velocities right after a blow: forces may act now that did not before it, and others read them where a step ends in the drift.
void PlaneImpulses::stop_at_once() {
  compression_ = rows_;
  for (PlaneRow& row : compression_) {
    const PlaneTouch& touch = state_.touch(row.touch);
    row.bias = std::max(touch.now.points[static_cast<std::size_t>(row.point)].separation, 0.0) / world_.step;
    row.tangent_bias = 0.0;
  }
  before_blow_ = unknowns_;
  begin_with(&PlaneBrick::velocity, before_blow_);
  solver_.solve(before_blow_, compression_, PlaneSolver::Guess::poor);
  for (PlaneBrick& brick : state_.bricks) {
    if (brick.moving) brick.velocity = before_blow_[static_cast<std::size_t>(brick.unknown)].velocity;
  }
}

// Restitution is Poisson's [Glocker1995]: every point gives back a share of the impulse that it took, and only where a bounce lasts longer
// than a step; a slower hit keeps the points together.
bool PlaneImpulses::blow(bool always) {
  const bool may_bounce = std::any_of(state_.near_pairs.begin(), state_.near_pairs.end(), [this](int pair) {
    const PlaneTouch& touch = state_.touch(pair);
    return touch.restitution > 0.0 && touch.now.count > 0;
  });
  if (!may_bounce && !always) return false;
  make_rows(&PlaneMemory::blow);
  begin_with(&PlaneBrick::velocity, unknowns_);
  const double slow = 0.5 * world_.gravity * world_.step;
  bool bounces = false;
  for (PlaneRow& row : rows_) {
    const PlaneTouch& touch = state_.touch(row.touch);
    row.bias = std::max(touch.now.points[static_cast<std::size_t>(row.point)].separation, 0.0) / world_.step;
    double closing = -product_of(row.normal_a, unknowns_[static_cast<std::size_t>(row.a)].velocity);
    if (row.b >= 0) closing -= product_of(row.normal_b, unknowns_[static_cast<std::size_t>(row.b)].velocity);
    bounces = bounces || (touch.restitution > 0.0 && touch.restitution * closing > slow);
  }
  if (!bounces && !always) return false;
  before_blow_ = unknowns_;
  solver_.solve(unknowns_, rows_, PlaneSolver::Guess::poor);
  if (bounces) give_back();
  for (PlaneBrick& brick : state_.bricks) {
    if (brick.moving) brick.velocity = unknowns_[static_cast<std::size_t>(brick.unknown)].velocity;
  }
  remember_impulses(0.0, &PlaneMemory::blow);
  return true;
}

void PlaneImpulses::give_back() {
  const auto energy = [](std::span<const PlaneUnknown> unknowns) {
    double sum = 0.0;
    for (const PlaneUnknown& u : unknowns) {
      sum += 0.5 * (u.mass * (u.velocity.x * u.velocity.x + u.velocity.z * u.velocity.z) + u.inertia * u.velocity.turn * u.velocity.turn);
    }
    return sum;
  };
  double most = 0.0;
  for (const PlaneRow& row : rows_) {
    if (row.normal > 0.0) most = std::max(most, state_.touch(row.touch).restitution);
  }
  compression_ = rows_;
  give_back_within(energy(before_blow_), most, [this](double share) { bounce_by(share); }, [&] { return energy(unknowns_); });
  for (PlaneRow& row : rows_) row.normal += row.base;
}

// From the velocities before the blow: all that the compression took, and this share of what should come back.
void PlaneImpulses::bounce_by(double share) {
  unknowns_ = before_blow_;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    PlaneRow& row = rows_[k];
    row.state = compression_[k].state;
    row.base = (1.0 + share * state_.touch(row.touch).restitution) * compression_[k].normal;
    const auto push = [&](int unknown, const Column<3>& j) {
      if (unknown < 0) return;
      PlaneUnknown& body = unknowns_[static_cast<std::size_t>(unknown)];
      body.velocity = body.velocity + row.base * PlaneVec{j[0] / body.mass, j[1] / body.mass, j[2] / body.inertia};
    };
    push(row.a, row.normal_a);
    push(row.b, row.normal_b);
  }
  solver_.solve(unknowns_, rows_);
}

}  // namespace topple::rigid
