#include "model/rigid/plane_drift.h"

#include <algorithm>
#include <cmath>

#include "model/rigid/passing.h"
#include "model/rigid/secant.h"

namespace topple::rigid {

namespace {

// How far no corner has gone beyond, from where the brick is to `box` [m].
double way_to(const PlaneBrick& brick, const PlaneBox& box) {
  const PlaneVec moved = box.place - brick.box.place;
  return std::abs(moved.x) + std::abs(moved.z) + brick.radius * std::abs(moved.turn);
}

// How far, at most, two bricks that end `parted` have gone past each other in the drift that is tried [m]; 0 if they cannot have met.
double way_between(const PlaneBrick& a, const PlaneBrick& b, double parted) {
  const PlaneVec of_a = a.next.place - a.box.place, of_b = b.next.place - b.box.place, apart = of_a - of_b;
  const double way = std::sqrt(apart.x * apart.x + apart.z * apart.z) + a.radius * std::abs(of_a.turn) + b.radius * std::abs(of_b.turn);
  return way > parted ? way : 0.0;
}

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

// What was tried is so; a point is the same where its feature is.
void accept(PlaneTouch& touch) {
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

}  // namespace

void PlaneDrift::begin(double whole, bool located) {
  under_way_ = true;
  whole_ = cut_ = whole;
  done_ = 0.0;
  if (located) {
    cut_ = find_cut();
  } else {
    try_to(whole);
  }
}

void PlaneDrift::follow(double whole, double cut) {
  under_way_ = true;
  whole_ = whole;
  cut_ = cut;
}

bool PlaneDrift::end(double time, double& work) {
  double done = 0.0;
  for (const PlaneForce& force : chain_.forces) done -= force.along * work_place(force);
  move_bricks(time);
  for (const PlaneForce& force : chain_.forces) done += force.along * work_place(force);
  work += done;
  for (const int pair : chain_.near_pairs) {
    PlaneTouch& touch = chain_.touch(pair);
    if (time < whole_) test_next(touch, chain_.brick(touch.a).box, chain_.brick(std::max(touch.b, 0)).box);
    accept(touch);
  }
  leave();
  return activate_new_points();
}

// How far along the row a force acts [m].
double PlaneDrift::work_place(const PlaneForce& force) const {
  const PlaneBrick& brick = chain_.brick(chain_.place_of(force.brick));
  return brick.box.place.x + force.x * brick.box.cosine + force.z * brick.box.sine;
}

// By `time` of the drift; if that is all of it, to where it was tried to.
void PlaneDrift::move_bricks(double time) {
  for (PlaneBrick& brick : chain_.bricks) {
    if (!brick.moving) continue;
    if (time < whole_) {
      const PlaneBox box = box_at(brick, time);
      brick.next_path = brick.path + way_to(brick, box);
      brick.box = box;
    } else {
      brick.box = brick.next;
    }
    brick.path = brick.next_path;
    brick.before_drift = brick.velocity;
    brick.velocity = brick.velocity + (2.0 * time / whole_) * (brick.middle - brick.velocity);
  }
}

// A brick after `time` of the drift [s].
PlaneBox PlaneDrift::box_at(const PlaneBrick& brick, double time) const {
  PlaneBox box = brick.box;
  if (!brick.moving) return box;
  // The acceleration is constant: 2 (middle - velocity) / whole.
  box.place = box.place + time * brick.velocity + (time * time / whole_) * (brick.middle - brick.velocity);
  set_turn(box);
  return box;
}

void PlaneDrift::test_next(PlaneTouch& touch, const PlaneBox& a, const PlaneBox& b) const {
  const double margin = world_.tolerances.margin * touch.thin;
  touch.next.axis = touch.now.axis;
  if (touch.b < 0) {
    touch_floor(a, margin, touch.next);
  } else {
    touch_boxes(a, b, margin, touch.next);
  }
}

// Finds points after `time` of the drift [s]. Pairs that are farther apart than their bricks can have gone since they were tested are not.
void PlaneDrift::try_to(double time) {
  for (PlaneBrick& brick : chain_.bricks) {
    brick.next = box_at(brick, time);
    brick.next_path = brick.path + (brick.moving ? way_to(brick, brick.next) : 0.0);
  }
  passing_ = 0.0;
  chain_.near_pairs.clear();
  for (std::size_t i = 0; i < chain_.touches.size(); ++i) {
    PlaneTouch& touch = chain_.touches[i];
    const PlaneBrick& a = chain_.brick(touch.a);
    const PlaneBrick& b = chain_.brick(touch.b < 0 ? touch.a : touch.b);
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
    if (touch.now.count + touch.next.count > 0) chain_.near_pairs.push_back(static_cast<int>(i));
  }
}

// When the first new point touches [s]; the whole drift if none does.
double PlaneDrift::find_cut() {
  return cut_of(whole_, [&](double time) { try_to(time); }, [&] { return passing_; }, [&](double time) { return first_impact(time); });
}

// When the first new point touches [s], of those that are deep at the time that was tried; that time if none is.
double PlaneDrift::first_impact(double time) const {
  double first = time;
  for (const int pair : chain_.near_pairs) {
    const PlaneTouch& touch = chain_.touch(pair);
    const double deep = world_.tolerances.located * touch.thin;
    for (int k = 0; k < touch.next.count; ++k) {
      const PlanePoint& point = touch.next.points[static_cast<std::size_t>(k)];
      if (point.separation > -deep || was_active(touch, point.feature)) continue;
      first = std::min(first, impact_of(touch, point, time));
    }
  }
  return first;
}

double PlaneDrift::distance_at(const PlaneTouch& touch, std::uint8_t feature, double time) const {
  PlaneManifold manifold;
  manifold.axis = touch.now.axis;
  const PlaneBox a = box_at(chain_.brick(touch.a), time);
  if (touch.b < 0) {
    touch_floor(a, 1e300, manifold);
  } else {
    touch_boxes(a, box_at(chain_.brick(touch.b), time), 1e300, manifold);
  }
  return new_distance(touch, manifold, feature, world_.tolerances.touching * touch.thin);
}

// The moment at which a point begins to touch that is deep after `time` of the drift.
double PlaneDrift::impact_of(const PlaneTouch& touch, const PlanePoint& point, double time) const {
  const double enough = world_.tolerances.located * touch.thin;
  return impact_between(
      time, world_.tolerances.touching * touch.thin, point.separation,
      [&](double moment) { return distance_at(touch, point.feature, moment); },
      [&](double distance) { return std::abs(distance) <= 1e-9 * enough; });
}

// Points that have come to touch take part from now on. Returns whether there are any.
bool PlaneDrift::activate_new_points() {
  bool any = false;
  for (const int pair : chain_.near_pairs) {
    PlaneTouch& touch = chain_.touch(pair);
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

PlaneBrick PlaneDrift::by_now(const PlaneBrick& brick) const {
  PlaneBrick out = brick;
  if (!under_way_ || !brick.moving) return out;
  out.box = box_at(brick, done_);
  out.velocity = brick.velocity + (2.0 * done_ / whole_) * (brick.middle - brick.velocity);
  return out;
}

// Where the points of a drift's beginning are by now.
PlaneManifold PlaneDrift::by_now(const PlaneTouch& touch) const {
  PlaneManifold out = touch.now, moved;
  moved.axis = touch.now.axis;
  const PlaneBox a = by_now(chain_.brick(touch.a)).box;
  const double far = touch.thin;
  if (touch.b < 0) {
    touch_floor(a, far, moved);
  } else {
    touch_boxes(a, by_now(chain_.brick(touch.b)).box, far, moved);
  }
  bool same = moved.count > 0;
  for (std::size_t k = 0; same && k < static_cast<std::size_t>(touch.now.count); ++k) {
    const auto end = moved.points.begin() + moved.count;
    const auto found =
        std::find_if(moved.points.begin(), end, [&](const PlanePoint& p) { return p.feature == touch.now.points[k].feature; });
    same = found != end;
    if (same) out.points[k] = *found;
  }
  if (!same) return touch.now;
  out.normal_x = moved.normal_x;
  out.normal_z = moved.normal_z;
  return out;
}

}  // namespace topple::rigid
