// The drift of a plane front, the impacts that cut it short, and their blows.
#include <algorithm>
#include <cmath>

#include "model/rigid/passing.h"
#include "model/rigid/plane_front.h"
#include "model/rigid/secant.h"

namespace topple::rigid {

PlaneBox PlaneFront::box_at(const PlaneBrick& brick, double time, double whole) const {
  PlaneBox box = brick.box;
  if (!brick.moving) return box;
  // The acceleration of this part is constant: 2 (middle - velocity) / whole.
  box.place = box.place + time * brick.velocity + (time * time / whole) * (brick.middle - brick.velocity);
  set_turn(box);
  return box;
}

// How far no corner has gone beyond, from where the brick is to `box` [m].
double PlaneFront::way_to(const PlaneBrick& brick, const PlaneBox& box) {
  const PlaneVec moved = box.place - brick.box.place;
  return std::abs(moved.x) + std::abs(moved.z) + brick.radius * std::abs(moved.turn);
}

// How far, at most, two bricks that end `parted` have gone past each other in the drift that is tried [m]; 0 if they cannot have met.
double PlaneFront::way_between(const PlaneBrick& a, const PlaneBrick& b, double parted) {
  const PlaneVec of_a = a.next.place - a.box.place, of_b = b.next.place - b.box.place, apart = of_a - of_b;
  const double way = std::sqrt(apart.x * apart.x + apart.z * apart.z) + a.radius * std::abs(of_a.turn) + b.radius * std::abs(of_b.turn);
  return way > parted ? way : 0.0;
}

// When the first new point touches in a drift of `whole` [s]; `whole` if none does.
double PlaneFront::find_cut(double whole) {
  return cut_of(
      whole, [&](double time) { try_drift(time, whole); }, [&] { return passing_; },
      [&](double time) { return first_impact(time, whole); });
}

// Points after `time` of a drift of `whole`. Pairs that are farther apart than their bricks can have gone since they were tested are not.
void PlaneFront::try_drift(double time, double whole) {
  for (PlaneBrick& brick : bricks_) {
    brick.next = box_at(brick, time, whole);
    brick.next_path = brick.path + (brick.moving ? way_to(brick, brick.next) : 0.0);
  }
  passing_ = 0.0;
  near_pairs_.clear();
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    PlaneTouch& touch = touches_[i];
    const PlaneBrick& a = bricks_[static_cast<std::size_t>(touch.a)];
    const PlaneBrick& b = bricks_[static_cast<std::size_t>(touch.b < 0 ? touch.a : touch.b)];
    const double path = touch.b < 0 ? a.path : a.path + b.path;
    const double next_path = touch.b < 0 ? a.next_path : a.next_path + b.next_path;
    if (touch.now.count == 0 && next_path < touch.apart_until) {
      touch.next.count = 0;
      continue;
    }
    test_next(touch, a.next, b.next);
    // The place that was tested may not be the one where the drift ends: there and back again.
    if (touch.next.count == 0) {
      touch.apart_until = 2.0 * path - next_path + touch.next.parted - world_.tolerances.margin * touch.thin;
      if (touch.b >= 0 && touch.now.count == 0 && next_path - path > touch.next.parted) {
        passing_ = std::max(passing_, way_between(a, b, touch.next.parted) / touch.thin);
      }
    }
    if (touch.now.count + touch.next.count > 0) near_pairs_.push_back(static_cast<int>(i));
  }
}

void PlaneFront::test_next(PlaneTouch& touch, const PlaneBox& a, const PlaneBox& b) const {
  const double margin = world_.tolerances.margin * touch.thin;
  touch.next.axis = touch.now.axis;
  if (touch.b < 0) {
    touch_floor(a, margin, touch.next);
  } else {
    touch_boxes(a, b, margin, touch.next);
  }
}

void PlaneFront::find_near_pairs() {
  near_pairs_.clear();
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    if (touches_[i].now.count + touches_[i].next.count > 0) near_pairs_.push_back(static_cast<int>(i));
  }
}

namespace {

bool was_active(const PlaneTouch& touch, std::uint8_t feature) {
  for (int k = 0; k < touch.now.count; ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (touch.now.points[at].feature == feature) return touch.memory[at].active;
  }
  return false;
}

// Whether it takes part, or is so near that it has just parted.
bool has_touched(const PlaneTouch& touch, std::uint8_t feature, double near) {
  for (int k = 0; k < touch.now.count; ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (touch.now.points[at].feature == feature) return touch.memory[at].active || touch.now.points[at].separation <= near;
  }
  return false;
}

// The distance of one point. Where faces are all but parallel its name may be another one now: then that of the nearest new one.
double new_distance(const PlaneTouch& touch, const PlaneManifold& manifold, std::uint8_t feature, double near) {
  if (manifold.count == 0) return manifold.parted;
  double least = 1e300;
  for (int k = 0; k < manifold.count; ++k) {
    const PlanePoint& point = manifold.points[static_cast<std::size_t>(k)];
    if (point.feature == feature) return point.separation;
    if (!has_touched(touch, point.feature, near)) least = std::min(least, point.separation);
  }
  return least;
}

}  // namespace

// When the first new point touches [s], of those that are deep at the time that was tried; that time if none is.
double PlaneFront::first_impact(double time, double whole) const {
  double first = time;
  for (const int pair : near_pairs_) {
    const PlaneTouch& touch = touches_[static_cast<std::size_t>(pair)];
    const double deep = world_.tolerances.located * touch.thin;
    for (int k = 0; k < touch.next.count; ++k) {
      const PlanePoint& point = touch.next.points[static_cast<std::size_t>(k)];
      if (point.separation > -deep || was_active(touch, point.feature)) continue;
      first = std::min(first, impact_of(touch, point, time, whole));
    }
  }
  return first;
}

double PlaneFront::distance_at(const PlaneTouch& touch, std::uint8_t feature, double time, double whole) const {
  PlaneManifold manifold;
  manifold.axis = touch.now.axis;
  const PlaneBox a = box_at(bricks_[static_cast<std::size_t>(touch.a)], time, whole);
  if (touch.b < 0) {
    touch_floor(a, 1e300, manifold);
  } else {
    touch_boxes(a, box_at(bricks_[static_cast<std::size_t>(touch.b)], time, whole), 1e300, manifold);
  }
  return new_distance(touch, manifold, feature, world_.tolerances.touching * touch.thin);
}

// The moment at which a point begins to touch that is deep after `time` of the drift.
double PlaneFront::impact_of(const PlaneTouch& touch, const PlanePoint& point, double time, double whole) const {
  const double enough = world_.tolerances.located * touch.thin;
  return impact_between(
      time, world_.tolerances.touching * touch.thin, point.separation,
      [&](double moment) { return distance_at(touch, point.feature, moment, whole); },
      [&](double distance) { return std::abs(distance) <= 1e-9 * enough; });
}

// Moves on by `cut` of a drift that was tried for `whole`; a point is the same where its feature is.
void PlaneFront::accept_drift(double cut, double whole) {
  double work = 0.0;
  const auto work_place = [this](const Force& force) {
    const PlaneBrick& brick = bricks_[static_cast<std::size_t>(place_of(force.brick))];
    return brick.box.place.x + force.x * brick.box.cosine + force.z * brick.box.sine;
  };
  for (const Force& force : forces_) work -= force.along * work_place(force);
  for (PlaneBrick& brick : bricks_) {
    if (!brick.moving) continue;
    if (cut < whole) {
      const PlaneBox box = box_at(brick, cut, whole);
      brick.next_path = brick.path + way_to(brick, box);
      brick.box = box;
    } else {
      brick.box = brick.next;
    }
    brick.path = brick.next_path;
    brick.before_drift = brick.velocity;
    brick.velocity = brick.velocity + (2.0 * cut / whole) * (brick.middle - brick.velocity);
  }
  for (const Force& force : forces_) work += force.along * work_place(force);
  ledger_.push_work += work;
  for (const int pair : near_pairs_) {
    PlaneTouch& touch = touches_[static_cast<std::size_t>(pair)];
    if (cut < whole) {
      test_next(touch, bricks_[static_cast<std::size_t>(touch.a)].box, bricks_[static_cast<std::size_t>(std::max(touch.b, 0))].box);
    }
    accept(touch);
  }
}

void PlaneFront::accept(PlaneTouch& touch) {
  bool same = touch.now.count == touch.next.count;
  for (std::size_t k = 0; k < 2; ++k) {
    same = same && (static_cast<int>(k) >= touch.now.count || touch.now.points[k].feature == touch.next.points[k].feature);
  }
  if (!same) {
    std::array<PlaneMemory, 2> memory;
    for (int k = 0; k < touch.next.count; ++k) {
      for (int j = 0; j < touch.now.count; ++j) {
        if (touch.now.points[static_cast<std::size_t>(j)].feature != touch.next.points[static_cast<std::size_t>(k)].feature) continue;
        memory[static_cast<std::size_t>(k)] = touch.memory[static_cast<std::size_t>(j)];
      }
    }
    touch.memory = memory;
  }
  for (PlaneMemory& memory : touch.memory) memory.fresh = false;
  touch.now = touch.next;
}

// Points that have come to touch take part from now on. Returns whether there are any.
bool PlaneFront::activate_new_points() {
  bool any = false;
  for (const int pair : near_pairs_) {
    PlaneTouch& touch = touches_[static_cast<std::size_t>(pair)];
    const double near = world_.tolerances.touching * touch.thin;
    for (int k = 0; k < touch.now.count; ++k) {
      PlaneMemory& memory = touch.memory[static_cast<std::size_t>(k)];
      if (memory.active || touch.now.points[static_cast<std::size_t>(k)].separation > near) continue;
      // It slips as the other point of the pair does, for a guess.
      const PlaneMemory& other = touch.memory[static_cast<std::size_t>(1 - k)];
      const double separation = touch.now.points[static_cast<std::size_t>(k)].separation;
      memory = {.active = true, .fresh = true, .overlap = std::max(-separation, 0.0)};
      if (touch.now.count == 2 && other.active && !other.fresh) memory.kick.grip = other.kick.grip;
      any = true;
    }
  }
  return any;
}

// Whether a point that has begun to touch closes so fast that it deserves a blow; a slower one is stopped by the next kick.
bool PlaneFront::closes_fast() const {
  const double slow = 0.5 * world_.gravity * world_.step;
  for (const int pair : near_pairs_) {
    const PlaneTouch& touch = touches_[static_cast<std::size_t>(pair)];
    for (int k = 0; k < touch.now.count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (!touch.memory[at].fresh) continue;
      const PlanePoint& point = touch.now.points[at];
      const auto approach = [&](int place) {
        const PlaneBrick& brick = bricks_[static_cast<std::size_t>(place)];
        const Column<3> j = rate(touch.now.normal_x, touch.now.normal_z, point.x - brick.box.place.x, point.z - brick.box.place.z);
        return product_of(j, brick.velocity);
      };
      if ((touch.b < 0 ? 0.0 : approach(touch.b)) - approach(touch.a) > slow) return true;
    }
  }
  return false;
}

// New points touch: the blow acts together with half a kick for the drift of `next` that follows. A bounce, which needs the blow by itself,
// comes before that. The drift before was planned for `whole`.
void PlaneFront::take_blow(double whole, double next) {
  const bool bounced = blow(false);
  for (PlaneBrick& brick : bricks_) {
    if (brick.moving) brick.acceleration = (2.0 / whole) * (brick.middle - brick.before_drift);
  }
  plan(next, !bounced, struck_now_.empty() ? nullptr : &strike_);
  for (const int pair : near_pairs_) touches_[static_cast<std::size_t>(pair)].load = 0.0;
  if (bounced) return keep_energy();
  stop_at_once();
}

// The velocities right after a blow: forces may act now that did not before it, and others read them where a step ends in the drift.
void PlaneFront::stop_at_once() {
  compression_ = rows_;
  for (PlaneRow& row : compression_) {
    const PlaneTouch& touch = touches_[static_cast<std::size_t>(row.touch)];
    row.bias = std::max(touch.now.points[static_cast<std::size_t>(row.point)].separation, 0.0) / world_.step;
    row.tangent_bias = 0.0;
  }
  before_blow_ = unknowns_;
  for (const PlaneBrick& brick : bricks_) {
    if (!brick.moving) continue;
    PlaneUnknown& unknown = before_blow_[static_cast<std::size_t>(brick.unknown)];
    unknown.velocity = unknown.guess = brick.velocity;
  }
  solver_.solve(before_blow_, compression_);
  for (PlaneBrick& brick : bricks_) {
    if (brick.moving) brick.velocity = before_blow_[static_cast<std::size_t>(brick.unknown)].velocity;
  }
}

// A blow by itself, `always` or only if something bounces; whether there was one. Restitution is Poisson's [Glocker1995]: every point gives
// back a share of the impulse that it took, and only where a bounce lasts longer than a step; a slower hit keeps the points together.
bool PlaneFront::blow(bool always) {
  const bool may_bounce = std::any_of(near_pairs_.begin(), near_pairs_.end(), [this](int pair) {
    const PlaneTouch& touch = touches_[static_cast<std::size_t>(pair)];
    return touch.restitution > 0.0 && touch.now.count > 0;
  });
  if (!may_bounce && !always) return false;
  make_rows(&PlaneMemory::blow);
  for (const PlaneBrick& brick : bricks_) {
    if (!brick.moving) continue;
    unknowns_[static_cast<std::size_t>(brick.unknown)].velocity = brick.velocity;
    unknowns_[static_cast<std::size_t>(brick.unknown)].guess = brick.velocity;
  }
  const double slow = 0.5 * world_.gravity * world_.step;
  bool bounces = false;
  for (PlaneRow& row : rows_) {
    const PlaneTouch& touch = touches_[static_cast<std::size_t>(row.touch)];
    row.bias = std::max(touch.now.points[static_cast<std::size_t>(row.point)].separation, 0.0) / world_.step;
    double closing = -product_of(row.normal_a, unknowns_[static_cast<std::size_t>(row.a)].velocity);
    if (row.b >= 0) closing -= product_of(row.normal_b, unknowns_[static_cast<std::size_t>(row.b)].velocity);
    bounces = bounces || (touch.restitution > 0.0 && touch.restitution * closing > slow);
  }
  if (!bounces && !always) return false;
  before_blow_ = unknowns_;
  solver_.solve(unknowns_, rows_);
  if (bounces) give_back();
  for (PlaneBrick& brick : bricks_) {
    if (brick.moving) brick.velocity = unknowns_[static_cast<std::size_t>(brick.unknown)].velocity;
  }
  remember_impulses(0.0, &PlaneMemory::blow);
  return true;
}

// The second half of a bounce: every point has its share of impulse more, at least. Where points share a blow or rub, that could make
// energy; then all shares are lowered until no more comes back than restitution squared of what the first half took, as Stronge has it.
void PlaneFront::give_back() {
  const auto energy = [](std::span<const PlaneUnknown> unknowns) {
    double sum = 0.0;
    for (const PlaneUnknown& u : unknowns) {
      sum += 0.5 * (u.mass * (u.velocity.x * u.velocity.x + u.velocity.z * u.velocity.z) + u.inertia * u.velocity.turn * u.velocity.turn);
    }
    return sum;
  };
  const double left = energy(unknowns_), taken = energy(before_blow_) - left;
  double most = 0.0;
  for (const PlaneRow& row : rows_) {
    if (row.normal > 0.0) most = std::max(most, touches_[static_cast<std::size_t>(row.touch)].restitution);
  }
  const double allowed = left + std::max(taken, 0.0) * most * most * (1.0 + 1e-3);
  compression_ = rows_;
  bounce_by(1.0);
  if (energy(unknowns_) > allowed) {
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 6; ++i) {
      const double share = 0.5 * (low + high);
      bounce_by(share);
      (energy(unknowns_) > allowed ? high : low) = share;
    }
    bounce_by(low);
  }
  for (PlaneRow& row : rows_) row.normal += row.base;
}

// From the velocities before the blow: all that the compression took, and this share of what should come back.
void PlaneFront::bounce_by(double share) {
  unknowns_ = before_blow_;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    PlaneRow& row = rows_[k];
    row.state = compression_[k].state;
    row.base = (1.0 + share * touches_[static_cast<std::size_t>(row.touch)].restitution) * compression_[k].normal;
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

bool PlaneFront::is_hit(const PlaneTouch& touch, const PlaneBrick& still) const {
  for (int k = 0; k < touch.now.count; ++k) {
    if (touch.memory[static_cast<std::size_t>(k)].fresh) return true;
  }
  return !touch.bearing && touch.load > world_.tolerances.load * world_.gravity * still.mass;
}

// Bricks that stand or rest and are hit in this moment begin to move, so that the impact acts on them.
void PlaneFront::wake_struck(double now) {
  for (bool again = true; again;) {
    again = false;
    for (const int pair : near_pairs_) {
      const PlaneTouch& touch = touches_[static_cast<std::size_t>(pair)];
      if (touch.b < 0 || touch.now.count == 0) continue;
      const PlaneBrick& a = bricks_[static_cast<std::size_t>(touch.a)];
      const PlaneBrick& b = bricks_[static_cast<std::size_t>(touch.b)];
      if (a.moving == b.moving || !is_hit(touch, a.moving ? b : a)) continue;
      struck_now_.push_back(a.moving ? Struck{b.id, a.id} : Struck{a.id, b.id});
      wake(struck_now_.back().brick, now);
      again = true;
      break;
    }
  }
}

}  // namespace topple::rigid
