// One step of a front: half a kick, a drift, half a kick, cut short at impacts.
//
// This is RATTLE [Andersen1983] with one-sided constraints: the first half kick takes the impulses that keep every active point from
// closing at the *end* of the drift, the second those that stop its approach there. Between impacts it is of second order. Impacts are
// located inside the step (the drift is cut short where a new point touches), so the order holds across them and the front speed does not
// lock in to the step.
#include <algorithm>
#include <cmath>
#include <limits>

#include "model/rigid/ball.h"
#include "model/rigid/wavefront.h"

namespace topple::rigid {

namespace {

// What a point knows of itself from before: that of the same feature, or else of the nearest point within `near` [m]. Faces that lie flush
// on each other swap their features at every rounding, and a stack stands by what its points remember.
const PointMemory* recall(const Touch& before, const TouchPoint& point, double near) {
  const PointMemory* same = nullptr;
  const PointMemory* found = nullptr;
  double nearest = near * near;
  for (int k = 0; k < before.manifold.count; ++k) {
    const TouchPoint& old = before.manifold.points[static_cast<std::size_t>(k)];
    const PointMemory& memory = before.memory[static_cast<std::size_t>(k)];
    if (old.feature == point.feature) same = &memory;
    const Vec3 apart = old.position - point.position;
    if (dot(apart, apart) >= nearest) continue;
    nearest = dot(apart, apart);
    found = &memory;
  }
  return same != nullptr ? same : found;
}

// Copies what two touches share.
void inherit(const Touch& before, double near, Touch& now) {
  for (int i = 0; i < now.manifold.count; ++i) {
    const PointMemory* memory = recall(before, now.manifold.points[static_cast<std::size_t>(i)], near);
    now.memory[static_cast<std::size_t>(i)] = memory != nullptr ? *memory : PointMemory{};
  }
}

}  // namespace

void Front::advance(double begin, std::span<const PushMoment> moments) {
  events_.clear();
  if (rested_) drop_idle();
  rested_ = false;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    members_[i].velocity_before = bodies_[i].velocity;
    members_[i].spin_before = bodies_[i].angular_velocity;
  }
  list_those_that_strayed();
  wake_unsupported(begin);
  find_touches(true);
  const double end = begin + world_.step;
  double now = begin;
  int cuts = 0;
  std::size_t next = 0;
  while (true) {
    while (next < moments.size() && moments[next].time <= now) {
      const PushMoment& moment = moments[next++];
      if (moment.push != nullptr) {
        begin_push(*moment.push, now);
      } else {
        std::erase_if(forces_, [&](const ActiveForce& f) { return f.brick == moment.brick && f.end <= now; });
        const int place = place_of(moment.brick);
        if (place >= 0) members_[static_cast<std::size_t>(place)].pushed = false;
      }
    }
    if (now >= end) break;
    const double until = next < moments.size() ? std::min(end, moments[next].time) : end;
    const double taken = part(now, until - now, cuts < world_.tolerances.cuts);
    if (taken < until - now) {
      ++cuts;
      now += taken;
    } else {
      now = until;
    }
  }
  retire(end);
}

// One part of the step, of at most `time`; returns how long it was.
double Front::part(double begin, double time, bool may_cut) {
  const double whole = time;
  int target = -1;
  std::uint32_t feature = 0;
  if (may_cut) {
    bodies_before_ = bodies_;
    touches_before_ = touches_;
  }
  for (int attempt = 0;; ++attempt) {
    positions(time);
    move(time);
    find_touches(false);
    if (!may_cut || attempt == 5) break;
    double cut = time;
    if (target < 0) {
      cut = first_impact(time, target, feature);
      if (target < 0) break;
    } else {
      // Newton's method on the distance of the point that was found first.
      int earlier = -1;
      std::uint32_t earlier_feature = 0;
      cut = first_impact(time, earlier, earlier_feature);
      if (earlier >= 0) {
        target = earlier;
        feature = earlier_feature;
      } else {
        cut = refine(time, whole, target, feature);
        if (cut == time) break;
      }
    }
    bodies_ = bodies_before_;
    touches_ = touches_before_;
    time = cut;
  }
  velocities(time, begin + time);
  note_arrivals(begin, time);
  return time;
}

void Front::kick(double time) {
  const Vec3 gravity{0.0, 0.0, -world_.gravity};
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!members_[i].moving) continue;
    bodies_[i].velocity = bodies_[i].velocity + time * gravity;
    if (bodies_[i].round) slow_ball(i, time);
  }
  for (const ActiveForce& force : forces_) {
    const int place = place_of(force.brick);
    if (place < 0) continue;
    Body& body = bodies_[static_cast<std::size_t>(place)];
    body.velocity = body.velocity + (time * body.inverse_mass) * force.force;
    body.angular_velocity = body.angular_velocity + time * (body.inverse_inertia * cross(body.axes * force.point, force.force));
  }
}

// A ball that touches the floor loses a little of its rolling.
void Front::slow_ball(std::size_t place, double time) {
  Body& ball = bodies_[place];
  if (ball.position.z - ball.half.x > world_.tolerances.touching * members_[place].thin) return;
  resist_rolling(ball, world_.layout.kinds[ball.kind].rolling_friction, world_.gravity, time);
}

void Front::solve_contacts() {
  solver_.apply_guess(bodies_);
  sweep();
}

void Front::sweep() {
  const double tolerance = world_.tolerances.velocity * std::sqrt(world_.gravity * world_.smallest);
  solver_.solve(bodies_, {tolerance, world_.tolerances.sweeps, world_.stacked});
}

void Front::positions(double time) {
  solver_.prepare_positions(bodies_, touches_, time, world_.step);
  kick(0.5 * time);
  solver_.guess(touches_, 0.5 * time);
  solve_contacts();
  for (const ContactRow& row : solver_.rows()) {
    PointMemory& memory = touches_[static_cast<std::size_t>(row.touch)].memory[static_cast<std::size_t>(row.point)];
    memory.normal_impulse = row.n;
    memory.friction_impulse = row.s * row.along + row.t * row.across;
  }
}

void Front::move(double time) {
  work_ = 0.0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!members_[i].moving) continue;
    members_[i].tilt_slope = cross(bodies_[i].angular_velocity, bodies_[i].axes * members_[i].local_up).z;
  }
  for (const ActiveForce& force : forces_) {
    const Body& body = bodies_[static_cast<std::size_t>(place_of(force.brick))];
    work_ -= dot(force.force, body.position + body.axes * force.point);
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!members_[i].moving) continue;
    drift(bodies_[i], time);
    members_[i].tilt_slope_end = cross(bodies_[i].angular_velocity, bodies_[i].axes * members_[i].local_up).z;
  }
  for (const ActiveForce& force : forces_) {
    const Body& body = bodies_[static_cast<std::size_t>(place_of(force.brick))];
    work_ += dot(force.force, body.position + body.axes * force.point);
  }
}

void Front::find_touches(bool first) {
  for (Touch& touch : touches_) {
    const Body& a = bodies_[static_cast<std::size_t>(touch.a)];
    double thin = members_[static_cast<std::size_t>(touch.a)].thin;
    before_.manifold = touch.manifold;
    before_.memory = touch.memory;
    if (touch.b == kFloor) {
      touch_floor(a, world_.tolerances.margin * thin, touch.manifold);
    } else {
      const Body& b = bodies_[static_cast<std::size_t>(touch.b)];
      thin = std::min(thin, members_[static_cast<std::size_t>(touch.b)].thin);
      const Vec3 apart = a.position - b.position;
      const double reach = a.radius + b.radius;
      touch.manifold.count = 0;
      if (dot(apart, apart) < reach * reach) touch_boxes(a, b, world_.tolerances.margin * thin, touch.axis, touch.manifold);
    }
    inherit(before_, world_.stacked ? world_.tolerances.touching * thin : 0.0, touch);
    for (int k = 0; k < touch.manifold.count; ++k) {
      PointMemory& memory = touch.memory[static_cast<std::size_t>(k)];
      memory.fresh = false;
      // What touches when a step begins has been touching: a brick that has just begun to move stands on its floor.
      if (first && touch.manifold.points[static_cast<std::size_t>(k)].separation < world_.tolerances.touching * thin) memory.active = true;
    }
  }
}

double Front::closing_speed(const Touch& touch, int point) const {
  const Vec3& at = touch.manifold.points[static_cast<std::size_t>(point)].position;
  const Body& a = bodies_[static_cast<std::size_t>(touch.a)];
  Vec3 slip = velocity_at(a, at - a.position);
  if (touch.b != kFloor) {
    const Body& b = bodies_[static_cast<std::size_t>(touch.b)];
    slip = slip - velocity_at(b, at - b.position);
  }
  return -dot(touch.manifold.normal, slip);
}

double Front::thinner(const Touch& touch) const {
  const double thin = members_[static_cast<std::size_t>(touch.a)].thin;
  return touch.b == kFloor ? thin : std::min(thin, members_[static_cast<std::size_t>(touch.b)].thin);
}

// When the first new point touches, and which [s]; `touch` stays -1 if none does before `time`.
double Front::first_impact(double time, int& touch, std::uint32_t& feature) const {
  double first = time;
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    const Touch& t = touches_[i];
    if (t.manifold.count == 0) continue;
    const double deep = -world_.tolerances.touching * thinner(t);
    for (int k = 0; k < t.manifold.count; ++k) {
      const TouchPoint& point = t.manifold.points[static_cast<std::size_t>(k)];
      if (t.memory[static_cast<std::size_t>(k)].active || point.separation > deep) continue;
      const double closing = closing_speed(t, k);
      if (closing <= 0.0 && touched_before(i)) continue;
      double at = closing > 0.0 ? time + point.separation / closing : 0.0;
      if (at < 1e-3 * world_.step) {
        // Either it touched from the start, or the depth is measured along another normal than that of the impact: then look earlier.
        if (touched_before(i)) continue;
        at = 0.25 * time;
      }
      if (at >= first) continue;
      first = at;
      touch = static_cast<int>(i);
      feature = point.feature;
    }
  }
  return first;
}

bool Front::touched_before(std::size_t touch) const {
  const Touch& before = touches_before_[touch];
  for (int k = 0; k < before.manifold.count; ++k) {
    if (before.memory[static_cast<std::size_t>(k)].active || before.manifold.points[static_cast<std::size_t>(k)].separation <= 0.0)
      return true;
  }
  return false;
}

// A better moment for the impact of one point, by Newton's method: `time` itself if it is good enough.
double Front::refine(double time, double whole, int touch, std::uint32_t feature) const {
  const Touch& t = touches_[static_cast<std::size_t>(touch)];
  for (int k = 0; k < t.manifold.count; ++k) {
    const TouchPoint& point = t.manifold.points[static_cast<std::size_t>(k)];
    if (point.feature != feature || t.memory[static_cast<std::size_t>(k)].active) continue;
    if (std::abs(point.separation) <= world_.tolerances.located * thinner(t)) return time;
    const double closing = closing_speed(t, k);
    if (closing <= 0.0) return time;
    const double at = time + point.separation / closing;
    return at <= 0.0 || at >= whole ? time : at;
  }
  return time;
}

// Points that have come to touch take part from now on. Returns whether there are any.
bool Front::activate_new_points() {
  bool any = false;
  for (Touch& touch : touches_) {
    if (touch.manifold.count == 0) continue;
    const double near = world_.tolerances.touching * thinner(touch);
    for (int k = 0; k < touch.manifold.count; ++k) {
      PointMemory& memory = touch.memory[static_cast<std::size_t>(k)];
      if (memory.active || touch.manifold.points[static_cast<std::size_t>(k)].separation > near) continue;
      memory.active = true;
      memory.fresh = true;
      any = true;
    }
  }
  return any;
}

// The second half kick, on points that have touched before; then, without gravity's time, the blow of those that touch from now on.
void Front::velocities(double time, double now) {
  solver_.prepare_velocities(bodies_, touches_, world_.step);
  kick(0.5 * time);
  solver_.guess(touches_, 0.5 * time);
  solve_contacts();
  ledger_.push_work += work_;
  work_ = 0.0;
  for (Touch& touch : touches_) touch.impulse = 0.0;
  remember_forces(time);
  struck_now_.clear();
  const bool fresh = activate_new_points();
  wake_struck(now);
  if (fresh || !struck_now_.empty()) {
    take_blow();
    note_struck(now);
    note_landed(now);
  }
  release_parting_points();
}

void Front::remember_forces(double time) {
  // In a very short part the solver's tolerance is too large a share of the impulse to tell the force.
  const bool worth_it = time > 0.1 * world_.step;
  for (const ContactRow& row : solver_.rows()) {
    Touch& touch = touches_[static_cast<std::size_t>(row.touch)];
    PointMemory& memory = touch.memory[static_cast<std::size_t>(row.point)];
    touch.impulse += row.n0 + row.n;
    if (worth_it) {
      memory.normal_force = (row.n0 + row.n) / time;
      memory.friction_force = (1.0 / time) * ((row.s0 + row.s) * row.along + (row.t0 + row.t) * row.across);
    }
    memory.normal_impulse = 0.0;
    memory.friction_impulse = {};
  }
}

// A point that parts has to come back to touch again.
void Front::release_parting_points() {
  const double slow = 0.5 * world_.gravity * world_.step;
  for (const ContactRow& row : solver_.rows()) {
    Touch& touch = touches_[static_cast<std::size_t>(row.touch)];
    if (-closing_speed(touch, row.point) > slow) touch.memory[static_cast<std::size_t>(row.point)].active = false;
  }
}

bool Front::is_hit(const Touch& touch, std::size_t still) const {
  double load = 0.0;
  for (int k = 0; k < touch.manifold.count; ++k) {
    const PointMemory& memory = touch.memory[static_cast<std::size_t>(k)];
    if (memory.fresh) return true;
    load += memory.normal_force;
  }
  const double weight = world_.gravity * world_.layout.kinds[bodies_[still].kind].mass;
  return !touch.bearing && load > world_.tolerances.load * weight;
}

// Bricks that stand or rest and are hit in this moment begin to move, so that the impact acts on them.
void Front::wake_struck(double now) {
  for (bool again = true; again;) {
    again = false;
    for (const Touch& touch : touches_) {
      if (touch.b == kFloor || touch.manifold.count == 0) continue;
      const bool a_moves = members_[static_cast<std::size_t>(touch.a)].moving;
      const bool b_moves = members_[static_cast<std::size_t>(touch.b)].moving;
      if (a_moves == b_moves) continue;
      const auto still = static_cast<std::size_t>(a_moves ? touch.b : touch.a);
      const auto mover = static_cast<std::size_t>(a_moves ? touch.a : touch.b);
      if (!is_hit(touch, still)) continue;
      struck_now_.push_back({bodies_[still].id, bodies_[mover].id});
      wake(bodies_[still].id, now);
      settle_on_floor(static_cast<int>(still));
      again = true;
      break;
    }
  }
}

// A brick that has just begun to move stands on what it stood on.
void Front::settle_on_floor(int place) {
  for (Touch& touch : touches_) {
    if (touch.b != kFloor || touch.a != place) continue;
    touch_floor(bodies_[static_cast<std::size_t>(place)], world_.tolerances.touching * members_[static_cast<std::size_t>(place)].thin,
                touch.manifold);
    touch.memory.fill(kTouching);
  }
}

}  // namespace topple::rigid
