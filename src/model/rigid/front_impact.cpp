// The drift of a front, the impacts that cut it short, and their blows.
#include <algorithm>
#include <cmath>

#include "model/rigid/passing.h"
#include "model/rigid/secant.h"
#include "model/rigid/wavefront.h"

namespace topple::rigid {

namespace {

// What a point knows of itself from before: that of the same feature, or else of the nearest point within `near` [m]. Faces that lie flush
// on each other swap their features at every rounding, and a stack stands by what its points remember.
const PointMemory* recall(const Touch& before, const TouchPoint& point, double near) {
  const PointMemory* same = nullptr;
  const PointMemory* found = nullptr;
  double nearest = near * near;
  for (int k = 0; k < before.now.count; ++k) {
    const TouchPoint& old = before.now.points[static_cast<std::size_t>(k)];
    const PointMemory& memory = before.memory[static_cast<std::size_t>(k)];
    if (old.feature == point.feature) same = &memory;
    const Vec3 apart = old.position - point.position;
    if (dot(apart, apart) >= nearest) continue;
    nearest = dot(apart, apart);
    found = &memory;
  }
  return same != nullptr ? same : found;
}

bool was_active(const Touch& touch, const TouchPoint& point, double near) {
  const PointMemory* memory = recall(touch, point, near);
  return memory != nullptr && memory->active;
}

// Whether it takes part, or is so near that it has just parted.
bool has_touched(const Touch& touch, const TouchPoint& point, double recalled, double near) {
  if (was_active(touch, point, recalled)) return true;
  for (int k = 0; k < touch.now.count; ++k) {
    const TouchPoint& now = touch.now.points[static_cast<std::size_t>(k)];
    if (now.feature == point.feature) return now.separation <= near;
  }
  return false;
}

void find(const Body& a, const Body* b, double margin, Manifold& out) {
  if (b == nullptr) return touch_floor(a, margin, out);
  const Vec3 apart = a.position - b->position;
  const double reach = a.radius + b->radius, squared = dot(apart, apart);
  if (squared > (reach + margin) * (reach + margin)) {
    out.count = 0;
    out.parted = std::sqrt(squared) - reach;
    return;
  }
  touch_boxes(a, *b, margin, out);
}

}  // namespace

// A body after `time` of a drift that is planned for `whole`. The acceleration of this part is constant, so the mean velocity until then
// lies as far towards the middle one.
Body Front::body_at(std::size_t place, double time, double whole) const {
  Body body = bodies_[place];
  if (!members_[place].moving) return body;
  const Twist& middle = members_[place].middle;
  const double share = time / whole;
  body.velocity = body.velocity + share * (middle.velocity - body.velocity);
  body.angular_velocity = body.angular_velocity + share * (middle.spin - body.angular_velocity);
  drift(body, time);
  return body;
}

double Front::thinner(const Touch& touch) const {
  const double thin = members_[static_cast<std::size_t>(touch.a)].thin;
  return touch.b == kFloor ? thin : std::min(thin, members_[static_cast<std::size_t>(touch.b)].thin);
}

void Front::find_next(const std::vector<Body>& bodies, Touch& touch) const {
  touch.next.axis = touch.now.axis;
  const Body* b = touch.b == kFloor ? nullptr : &bodies[static_cast<std::size_t>(touch.b)];
  find(bodies[static_cast<std::size_t>(touch.a)], b, world_.tolerances.margin * thinner(touch), touch.next);
}

// What touches at this moment has been touching.
void Front::find_now(Touch& touch) const {
  const double near = world_.tolerances.touching * thinner(touch);
  const Body* b = touch.b == kFloor ? nullptr : &bodies_[static_cast<std::size_t>(touch.b)];
  find(bodies_[static_cast<std::size_t>(touch.a)], b, world_.tolerances.margin * thinner(touch), touch.now);
  touch.memory = {};
  for (int k = 0; k < touch.now.count; ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (touch.now.points[at].separation < near) touch.memory[at] = kTouching;
  }
}

// When the first new point touches in a drift of `whole` [s]; `whole` if none does.
double Front::find_cut(double whole) {
  return cut_of(
      whole, [&](double time) { try_drift(time, whole); }, [&] { return farthest_passing(whole); },
      [&](double time) { return first_impact(time, whole); });
}

// How far two bricks go past each other that are apart and may have met in the drift that is tried, at most [thicknesses].
double Front::farthest_passing(double time) const {
  double farthest = 0.0;
  const auto moved = [this](int place) {
    return ahead_[static_cast<std::size_t>(place)].position - bodies_[static_cast<std::size_t>(place)].position;
  };
  const auto turned = [this, time](int place) {
    return members_[static_cast<std::size_t>(place)].moving
               ? bodies_[static_cast<std::size_t>(place)].radius * time * norm(members_[static_cast<std::size_t>(place)].middle.spin)
               : 0.0;
  };
  for (const Touch& touch : touches_) {
    if (touch.b == kFloor || touch.now.count > 0 || touch.next.count > 0) continue;
    const double way = norm(moved(touch.a) - moved(touch.b)) + turned(touch.a) + turned(touch.b);
    if (way > touch.next.parted) farthest = std::max(farthest, way / thinner(touch));
  }
  return farthest;
}

// Points after `time` of a drift of `whole`.
void Front::try_drift(double time, double whole) {
  ahead_.resize(bodies_.size());
  for (std::size_t i = 0; i < bodies_.size(); ++i) ahead_[i] = body_at(i, time, whole);
  for (Touch& touch : touches_) find_next(ahead_, touch);
}

// When the first new point touches [s], of those that are deep at the time that was tried; that time if none is.
double Front::first_impact(double time, double whole) const {
  double first = time;
  for (const Touch& touch : touches_) {
    // Flush faces come and go by a hair's breadth.
    const double deep = (world_.stacked ? world_.tolerances.touching : world_.tolerances.located) * thinner(touch);
    const double recalled = recall_within(touch);
    for (int k = 0; k < touch.next.count; ++k) {
      const TouchPoint& point = touch.next.points[static_cast<std::size_t>(k)];
      if (point.separation > -deep || was_active(touch, point, recalled)) continue;
      first = std::min(first, impact_of(touch, point, time, whole));
    }
  }
  return first;
}

// Flush faces swap their features at every rounding.
double Front::recall_within(const Touch& touch) const { return world_.stacked ? world_.tolerances.touching * thinner(touch) : 0.0; }

// The distance of one point at a moment of the drift.
double Front::distance_at(const Touch& touch, std::uint32_t feature, double time, double whole) const {
  Manifold manifold;
  manifold.axis = touch.now.axis;
  const Body a = body_at(static_cast<std::size_t>(touch.a), time, whole);
  if (touch.b == kFloor) {
    find(a, nullptr, 1e300, manifold);
  } else {
    const Body b = body_at(static_cast<std::size_t>(touch.b), time, whole);
    find(a, &b, 1e300, manifold);
  }
  if (manifold.count == 0) return manifold.parted;
  // Where faces are all but parallel a point may have another name now: then it is the nearest new one.
  const double near = world_.tolerances.touching * thinner(touch), recalled = recall_within(touch);
  double least = 1e300;
  for (int k = 0; k < manifold.count; ++k) {
    const TouchPoint& point = manifold.points[static_cast<std::size_t>(k)];
    if (point.feature == feature) return point.separation;
    if (!has_touched(touch, point, recalled, near)) least = std::min(least, point.separation);
  }
  return least;
}

// The moment at which a point begins to touch that is deep after `time` of the drift.
double Front::impact_of(const Touch& touch, const TouchPoint& point, double time, double whole) const {
  const double thin = thinner(touch), enough = world_.tolerances.located * thin;
  return impact_between(
      time, world_.tolerances.touching * thin, point.separation,
      [&](double moment) { return distance_at(touch, point.feature, moment, whole); },
      [&](double distance) { return std::abs(distance) <= enough; });
}

// Moves on by `cut` of a drift that was tried for `whole`; a point is the same where its feature is.
void Front::accept_drift(double begin, double cut, double whole) {
  double work = 0.0;
  const auto work_place = [this](const ActiveForce& force) {
    const Body& body = bodies_[static_cast<std::size_t>(place_of(force.brick))];
    return dot(force.force, body.position + body.axes * force.point);
  };
  for (const ActiveForce& force : forces_) work -= work_place(force);
  const double share = cut / whole;
  const double before = cut < whole ? moving_energy() : 0.0;
  double lifted = 0.0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Member& member = members_[i];
    if (!member.moving) continue;
    Body& body = bodies_[i];
    const Twist start{body.velocity, body.angular_velocity};
    const Vec3 gain = member.middle.velocity - start.velocity, spin_gain = member.middle.spin - start.spin;
    const double slope = cross(start.spin, body.axes * member.local_up).z, height = body.position.z;
    body = cut < whole ? body_at(i, cut, whole) : ahead_[i];
    member.middle.spin = body.angular_velocity;  // As the drift has turned it.
    body.velocity = start.velocity + (2.0 * share) * gain;
    body.angular_velocity = body.angular_velocity + share * spin_gain;
    lifted += world_.gravity * (body.position.z - height) / body.inverse_mass;
    member.gain = {(2.0 / whole) * gain, (2.0 / whole) * spin_gain};
    note_arrival(i, begin, cut, slope, cross(body.angular_velocity, body.axes * member.local_up).z);
  }
  for (const ActiveForce& force : forces_) work += work_place(force);
  ledger_.push_work += work;
  if (cut < whole) rein_in(before + work - lifted);
  for (Touch& touch : touches_) {
    if (cut < whole) find_next(bodies_, touch);
    if (touch.next.count == 0) {
      touch.now.take(touch.next);
      continue;
    }
    before_.now.take(touch.now);
    std::copy_n(touch.memory.begin(), touch.now.count, before_.memory.begin());
    for (int k = 0; k < touch.next.count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const PointMemory* memory = recall(before_, touch.next.points[at], recall_within(touch));
      touch.memory[at] = memory != nullptr ? *memory : PointMemory{};
      touch.memory[at].fresh = false;
    }
    touch.now.take(touch.next);
  }
}

double Front::closing_speed(const Touch& touch, int point) const {
  const Vec3& at = touch.now.points[static_cast<std::size_t>(point)].position;
  const Body& a = bodies_[static_cast<std::size_t>(touch.a)];
  Vec3 slip = velocity_at(a, at - a.position);
  if (touch.b != kFloor) {
    const Body& b = bodies_[static_cast<std::size_t>(touch.b)];
    slip = slip - velocity_at(b, at - b.position);
  }
  return -dot(touch.now.normal, slip);
}

// Points that have come to touch take part from now on. Returns whether there are any.
bool Front::activate_new_points() {
  bool any = false;
  for (Touch& touch : touches_) {
    if (touch.now.count == 0) continue;
    const double near = world_.tolerances.touching * thinner(touch);
    bool slides = false;
    for (int k = 0; k < touch.now.count; ++k) {
      const PointMemory& memory = touch.memory[static_cast<std::size_t>(k)];
      slides = slides || (memory.active && !memory.fresh && memory.kick.slides);
    }
    for (int k = 0; k < touch.now.count; ++k) {
      PointMemory& memory = touch.memory[static_cast<std::size_t>(k)];
      if (memory.active || touch.now.points[static_cast<std::size_t>(k)].separation > near) continue;
      memory = kTouching;
      memory.fresh = true;
      memory.kick.slides = slides;  // As the others of the pair do, for a guess.
      any = true;
    }
  }
  return any;
}

// Whether a point that has begun to touch closes so fast that it deserves a blow; a slower one is stopped by the next kick.
bool Front::closes_fast() const {
  const double slow = 0.5 * world_.gravity * world_.step;
  for (const Touch& touch : touches_) {
    for (int k = 0; k < touch.now.count; ++k) {
      if (touch.memory[static_cast<std::size_t>(k)].fresh && closing_speed(touch, k) > slow) return true;
    }
  }
  return false;
}

// New points touch: the blow acts together with half a kick for the drift of `next` that follows. A bounce, which needs the blow by itself,
// comes before that. The drift before was planned for `whole`.
void Front::take_blow(double next, bool ends_step) {
  // At the end of a step others read the velocities right after it, and forces may act then that did not before.
  const bool bounced = blow(ends_step && struck_now_.empty());
  plan(next, !bounced);
  for (Touch& touch : touches_) touch.load = 0.0;
  if (bounced) {
    stop_at_once();
    return keep_energy();
  }
  const double before = moving_energy();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!members_[i].moving) continue;
    set_twist(bodies_[i], after_the_blow(members_[i], next));
    bodies_[i].gyroscopic = free_rotation(bodies_[i]);
  }
  if (moving_energy() <= before + spare_energy()) return;
  for (std::size_t i = 0; i < bodies_.size(); ++i) set_twist(bodies_[i], now_[i]);
  stop_at_once();
}

// Points that close after a bounce, since others have bounced against them, are stopped within the half kick that is planned. The
// velocities of this moment must not have them any more: a drift that is cut short would go as far beyond the planned ones as it was below
// them.
void Front::stop_at_once() {
  make_rows(&PointMemory::blow, 0.0);
  for (ContactRow& row : rows_) {
    const Touch& touch = touches_[static_cast<std::size_t>(row.touch)];
    row.bias = {std::max(touch.now.points[static_cast<std::size_t>(row.point)].separation, 0.0) / world_.step, 0.0, 0.0};
  }
  free_.clear();
  for (const Body& body : bodies_) free_.push_back({body.velocity, body.angular_velocity});
  solve_contacts(free_);
}

// A blow by itself, `always` or only if something bounces; whether there was one. Restitution is Poisson's [Glocker1995]: every point gives
// back a share of the impulse that it took, and only where a bounce lasts longer than a step; a slower hit keeps the points together.
bool Front::blow(bool always) {
  const bool may_bounce =
      std::any_of(touches_.begin(), touches_.end(), [](const Touch& touch) { return touch.restitution > 0.0 && touch.now.count > 0; });
  if (!may_bounce && !always) return false;
  make_rows(&PointMemory::blow, 0.0);
  const double slow = 0.5 * world_.gravity * world_.step;
  bool bounces = false;
  for (ContactRow& row : rows_) {
    const Touch& touch = touches_[static_cast<std::size_t>(row.touch)];
    row.bias = {std::max(touch.now.points[static_cast<std::size_t>(row.point)].separation, 0.0) / world_.step, 0.0, 0.0};
    bounces = bounces || (touch.restitution > 0.0 && touch.restitution * closing_speed(touch, row.point) > slow);
  }
  if (!bounces && !always) return false;
  free_.clear();
  for (const Body& body : bodies_) free_.push_back({body.velocity, body.angular_velocity});
  const double before = moving_energy();
  solve_contacts(free_);
  if (bounces) give_back(before);
  remember_impulses(0.0, &PointMemory::blow);
  return true;
}

// The second half of a bounce: every point has its share of impulse more, at least. Where points share a blow or rub, that could make
// energy; then all shares are lowered until no more comes back than restitution squared of what the first half took, as Stronge has it.
// `before` is the energy that there was before the blow.
void Front::give_back(double before) {
  const double left = moving_energy(), taken = before - left;
  double most = 0.0;
  for (const ContactRow& row : rows_) {
    if (row.impulse[0] > 0.0) most = std::max(most, touches_[static_cast<std::size_t>(row.touch)].restitution);
  }
  const double allowed = left + std::max(taken, 0.0) * most * most * (1.0 + 1e-3);
  compression_ = rows_;
  bounce_by(1.0);
  if (moving_energy() > allowed) {
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 6; ++i) {
      const double share = 0.5 * (low + high);
      bounce_by(share);
      (moving_energy() > allowed ? high : low) = share;
    }
    bounce_by(low);
  }
  for (ContactRow& row : rows_) row.impulse[0] += row.base;
}

// From the velocities before the blow: all that the compression took, and this share of what should come back.
void Front::bounce_by(double share) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    bodies_[i].velocity = free_[i].velocity;
    bodies_[i].angular_velocity = free_[i].spin;
  }
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    ContactRow& row = rows_[k];
    row.state = compression_[k].state;
    row.base = (1.0 + share * touches_[static_cast<std::size_t>(row.touch)].restitution) * compression_[k].impulse[0];
    row.impulse = {};
    const auto push = [&](int place, const Vec3& impulse, const Vec3& arm) {
      Body& body = bodies_[static_cast<std::size_t>(place)];
      body.velocity = body.velocity + body.inverse_mass * impulse;
      body.angular_velocity = body.angular_velocity + body.inverse_inertia * cross(arm, impulse);
    };
    push(row.a, row.base * row.normal, row.arm_a);
    if (row.b != kFloor) push(row.b, -row.base * row.normal, row.arm_b);
  }
  solve_contacts(free_);
}

bool Front::is_hit(const Touch& touch, std::size_t still) const {
  for (int k = 0; k < touch.now.count; ++k) {
    if (touch.memory[static_cast<std::size_t>(k)].fresh) return true;
  }
  const double weight = world_.gravity * world_.kinds[bodies_[still].kind].mass;
  return !touch.bearing && touch.load > world_.tolerances.load * weight;
}

// Bricks that stand or rest and are hit in this moment begin to move, so that the impact acts on them.
void Front::wake_struck(double now) {
  for (bool again = true; again;) {
    again = false;
    for (const Touch& touch : touches_) {
      if (touch.b == kFloor || touch.now.count == 0) continue;
      const bool a_moves = members_[static_cast<std::size_t>(touch.a)].moving;
      const bool b_moves = members_[static_cast<std::size_t>(touch.b)].moving;
      if (a_moves == b_moves) continue;
      const auto still = static_cast<std::size_t>(a_moves ? touch.b : touch.a);
      const auto mover = static_cast<std::size_t>(a_moves ? touch.a : touch.b);
      if (!is_hit(touch, still)) continue;
      struck_now_.push_back({bodies_[still].id, bodies_[mover].id});
      wake(bodies_[still].id, now);
      again = true;
      break;
    }
  }
}

}  // namespace topple::rigid
