// Blows: what new points do to the bricks of a front with six degrees of freedom, in no time.
#include <algorithm>

#include "model/rigid/free_impulses.h"
#include "model/rigid/restitution.h"

namespace topple::rigid {

bool FreeImpulses::closes_fast() const {
  const double slow = 0.5 * world_.gravity * world_.step;
  for (const Touch& touch : bricks_.touches) {
    for (int k = 0; k < touch.now.count; ++k) {
      if (touch.memory[static_cast<std::size_t>(k)].fresh && bricks_.closing_speed(touch, k) > slow) return true;
    }
  }
  return false;
}

bool FreeImpulses::take_blow(double next, bool read_now) {
  const bool bounced = blow(read_now);
  plan(next, !bounced);
  for (Touch& touch : bricks_.touches) touch.load = 0.0;
  if (bounced) {
    stop_at_once();
    return true;
  }
  const double before = bricks_.moving_energy();
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    if (!bricks_.members[i].moving) continue;
    set_twist(bricks_.bodies[i], after_the_blow(bricks_.members[i], next));
    bricks_.bodies[i].gyroscopic = free_rotation(bricks_.bodies[i]);
  }
  if (bricks_.moving_energy() <= before + bricks_.spare_energy(world_.gravity)) return false;
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) set_twist(bricks_.bodies[i], now_[i]);
  stop_at_once();
  return false;
}

// Points that close after a bounce, since others have bounced against them, are stopped within the half kick that is planned. The
// velocities of this moment must not have them any more: a drift that is cut short would go as far beyond the planned ones as it was below
// them.
void FreeImpulses::stop_at_once() {
  make_rows(&PointMemory::blow, 0.0);
  for (ContactRow& row : rows_) {
    const Touch& touch = bricks_.touch(row.touch);
    row.bias = {std::max(touch.now.points[static_cast<std::size_t>(row.point)].separation, 0.0) / world_.step, 0.0, 0.0};
  }
  free_.clear();
  for (const Body& body : bricks_.bodies) free_.push_back({body.velocity, body.angular_velocity});
  solve_contacts(free_);
}

// Restitution is Poisson's [Glocker1995]: every point gives back a share of the impulse that it took, and only where a bounce lasts longer
// than a step; a slower hit keeps the points together.
bool FreeImpulses::blow(bool always) {
  const bool may_bounce = std::any_of(bricks_.touches.begin(), bricks_.touches.end(),
                                      [](const Touch& touch) { return touch.restitution > 0.0 && touch.now.count > 0; });
  if (!may_bounce && !always) return false;
  make_rows(&PointMemory::blow, 0.0);
  const double slow = 0.5 * world_.gravity * world_.step;
  bool bounces = false;
  for (ContactRow& row : rows_) {
    const Touch& touch = bricks_.touch(row.touch);
    row.bias = {std::max(touch.now.points[static_cast<std::size_t>(row.point)].separation, 0.0) / world_.step, 0.0, 0.0};
    bounces = bounces || (touch.restitution > 0.0 && touch.restitution * bricks_.closing_speed(touch, row.point) > slow);
  }
  if (!bounces && !always) return false;
  free_.clear();
  for (const Body& body : bricks_.bodies) free_.push_back({body.velocity, body.angular_velocity});
  const double before = bricks_.moving_energy();
  solve_contacts(free_);
  if (bounces) give_back(before);
  remember_impulses(0.0, &PointMemory::blow);
  return true;
}

// `before` is the energy that there was before the blow [J].
void FreeImpulses::give_back(double before) {
  double most = 0.0;
  for (const ContactRow& row : rows_) {
    if (row.impulse[0] > 0.0) most = std::max(most, bricks_.touch(row.touch).restitution);
  }
  compression_ = rows_;
  give_back_within(before, most, [this](double share) { bounce_by(share); }, [this] { return bricks_.moving_energy(); });
  for (ContactRow& row : rows_) row.impulse[0] += row.base;
}

// From the velocities before the blow: all that the compression took, and this share of what should come back.
void FreeImpulses::bounce_by(double share) {
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    bricks_.bodies[i].velocity = free_[i].velocity;
    bricks_.bodies[i].angular_velocity = free_[i].spin;
  }
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    ContactRow& row = rows_[k];
    row.state = compression_[k].state;
    row.base = (1.0 + share * bricks_.touch(row.touch).restitution) * compression_[k].impulse[0];
    row.impulse = {};
    const auto push = [&](int place, const Vec3& impulse, const Vec3& arm) {
      Body& body = bricks_.body(place);
      body.velocity = body.velocity + body.inverse_mass * impulse;
      body.angular_velocity = body.angular_velocity + body.inverse_inertia * cross(arm, impulse);
    };
    push(row.a, row.base * row.normal, row.arm_a);
    if (row.b != kFloor) push(row.b, -row.base * row.normal, row.arm_b);
  }
  solve_contacts(free_);
}

}  // namespace topple::rigid
