#include "model/rigid/free_drift.h"

#include <algorithm>
#include <cmath>

#include "model/rigid/passing.h"
#include "model/rigid/secant.h"

namespace topple::rigid {

namespace {

// What a drift that is cut short may make of the kinetic energy there is, by its own inexactness.
constexpr double kSpare = 1e-3;

// Where a drift was cut short and nothing new touches then, a point had only got another name. It might do so again at once, so the next
// cut is no sooner than after this share of the drift.
constexpr double kAfterIdle = 1.0 / 16.0;

// The moment in a drift, as a share of it, at which a cosine that begins at c0 with slope d0 and ends at c1 with slope d1 passes
// `level`.
double crossing(double c0, double d0, double c1, double d1, double level) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double s = 0.5 * (low + high);
    const double u = 1.0 - s;
    const double value = u * u * ((1.0 + 2.0 * s) * c0 + s * d0) + s * s * ((1.0 + 2.0 * u) * c1 - u * d1);
    (value > level ? low : high) = s;
  }
  return 0.5 * (low + high);
}

constexpr double kArrivalCosine = 0.98480775301220802;  // cos(kArrivalTilt)

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

}  // namespace

void FreeDrift::begin(double whole, bool located) {
  whole_ = cut_ = whole;
  if (located) {
    cut_ = cut_of(
        whole_, [&](double time) { try_to(time); }, [&] { return farthest_passing(); }, [&](double time) { return first_impact(time); });
    if (idle_) cut_ = std::max(cut_, kAfterIdle * whole_);
  } else {
    try_to(whole);
  }
}

bool FreeDrift::end(double& work) {
  const double before = cut_ < whole_ ? bricks_.moving_energy() : 0.0;
  double done = 0.0;
  for (const ActiveForce& force : bricks_.forces) done -= work_place(force);
  const double lifted = move_bricks();
  for (const ActiveForce& force : bricks_.forces) done += work_place(force);
  work += done;
  if (cut_ < whole_) rein_in(before + done - lifted);
  for (Touch& touch : bricks_.touches) {
    if (cut_ < whole_) find_next(bricks_.bodies, touch);
    accept(touch);
  }
  const bool fresh = activate_new_points();
  idle_ = cut_ < whole_ && !fresh;
  return fresh;
}

// Force times the way along it, up to a constant [J].
double FreeDrift::work_place(const ActiveForce& force) const {
  const Body& body = bricks_.body(bricks_.place_of(force.brick));
  return dot(force.force, body.position + body.axes * force.point);
}

// To the end of the drift, which may be an impact; what that took against gravity [J].
double FreeDrift::move_bricks() {
  arrivals_.clear();
  const double share = cut_ / whole_;
  double lifted = 0.0;
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    Member& member = bricks_.members[i];
    if (!member.moving) continue;
    Body& body = bricks_.bodies[i];
    const Twist start{body.velocity, body.angular_velocity};
    const Vec3 gain = member.middle.velocity - start.velocity, spin_gain = member.middle.spin - start.spin;
    const double slope = cross(start.spin, body.axes * member.local_up).z, height = body.position.z;
    body = cut_ < whole_ ? body_at(i, cut_) : ahead_[i];
    member.middle.spin = body.angular_velocity;  // As the drift has turned it.
    body.velocity = start.velocity + (2.0 * share) * gain;
    body.angular_velocity = body.angular_velocity + share * spin_gain;
    lifted += world_.gravity * (body.position.z - height) / body.inverse_mass;
    member.gain = {(2.0 / whole_) * gain, (2.0 / whole_) * spin_gain};
    note_arrival(i, slope, cross(body.angular_velocity, body.axes * member.local_up).z);
  }
  return lifted;
}

// Whether the tilt of a brick has passed that of an arrival, from how its cosine changed at both ends.
void FreeDrift::note_arrival(std::size_t place, double slope_before, double slope_after) {
  Member& member = bricks_.members[place];
  const double before = member.tilt_cosine;
  member.tilt_cosine = (bricks_.bodies[place].axes * member.local_up).z;
  if (world_.arrived[static_cast<std::size_t>(bricks_.bodies[place].id)] != 0 || member.tilt_cosine > kArrivalCosine) return;
  const double share = crossing(before, cut_ * slope_before, member.tilt_cosine, cut_ * slope_after, kArrivalCosine);
  arrivals_.push_back({bricks_.bodies[place].id, share * cut_});
}

// What was tried is so; a point is the same where its feature is.
void FreeDrift::accept(Touch& touch) {
  if (touch.next.count == 0) {
    touch.now.take(touch.next);
    return;
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

// At an impact within a drift velocities are as far beyond the middle ones as those at its beginning were below them. Where the half kick
// at its beginning stopped something, that would throw it back: then they go only so far beyond that they have no more than this kinetic
// energy [J].
void FreeDrift::rein_in(double most) {
  const double beyond = bricks_.moving_energy();
  if (beyond <= most * (1.0 + kSpare)) return;
  found_.clear();
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    const Twist found = twist_of(bricks_.bodies[i]);
    const Twist& middle = bricks_.members[i].middle;
    found_.push_back(found);
    if (bricks_.members[i].moving) set_twist(bricks_.bodies[i], {found.velocity - middle.velocity, found.spin - middle.spin});
  }
  const double change = bricks_.moving_energy();
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    if (bricks_.members[i].moving) set_twist(bricks_.bodies[i], bricks_.members[i].middle);
  }
  // That of middle + share x change is at_middle + share x both + share^2 x change.
  const double at_middle = bricks_.moving_energy(), both = beyond - at_middle - change, left = at_middle - most;
  const double root = both * both - 4.0 * change * left;
  const double share = left >= 0.0 || root < 0.0 || change <= 0.0 ? 0.0 : std::clamp((std::sqrt(root) - both) / (2.0 * change), 0.0, 1.0);
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    if (!bricks_.members[i].moving) continue;
    const Twist& middle = bricks_.members[i].middle;
    set_twist(bricks_.bodies[i],
              {middle.velocity + share * (found_[i].velocity - middle.velocity), middle.spin + share * (found_[i].spin - middle.spin)});
  }
}

// A body after `time` of the drift [s]. Its acceleration is constant, so the mean velocity until then lies as far towards the middle one.
Body FreeDrift::body_at(std::size_t place, double time) const {
  Body body = bricks_.bodies[place];
  if (!bricks_.members[place].moving) return body;
  const Twist& middle = bricks_.members[place].middle;
  const double share = time / whole_;
  body.velocity = body.velocity + share * (middle.velocity - body.velocity);
  body.angular_velocity = body.angular_velocity + share * (middle.spin - body.angular_velocity);
  drift(body, time);
  return body;
}

void FreeDrift::find_next(const std::vector<Body>& bodies, Touch& touch) const {
  touch.next.axis = touch.now.axis;
  const Body* b = touch.b == kFloor ? nullptr : &bodies[static_cast<std::size_t>(touch.b)];
  touch_body(bodies[static_cast<std::size_t>(touch.a)], b, world_.tolerances.margin * bricks_.thinner(touch), touch.next);
}

// How far two bricks go past each other that are apart and may have met in the drift that is tried, at most [thicknesses].
double FreeDrift::farthest_passing() const {
  double farthest = 0.0;
  const auto moved = [this](int place) { return ahead_[static_cast<std::size_t>(place)].position - bricks_.body(place).position; };
  const auto turned = [this](int place) {
    return bricks_.member(place).moving ? bricks_.body(place).radius * whole_ * norm(bricks_.member(place).middle.spin) : 0.0;
  };
  for (const Touch& touch : bricks_.touches) {
    if (touch.b == kFloor || touch.now.count > 0 || touch.next.count > 0) continue;
    const double way = norm(moved(touch.a) - moved(touch.b)) + turned(touch.a) + turned(touch.b);
    if (way > touch.next.parted) farthest = std::max(farthest, way / bricks_.thinner(touch));
  }
  return farthest;
}

// Finds points after `time` of the drift [s].
void FreeDrift::try_to(double time) {
  ahead_.resize(bricks_.bodies.size());
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) ahead_[i] = body_at(i, time);
  for (Touch& touch : bricks_.touches) find_next(ahead_, touch);
}

// When the first new point touches [s], of those that are deep at the time that was tried; that time if none is.
double FreeDrift::first_impact(double time) const {
  double first = time;
  for (const Touch& touch : bricks_.touches) {
    // Flush faces come and go by a hair's breadth.
    const double deep = (world_.stacked ? world_.tolerances.touching : world_.tolerances.located) * bricks_.thinner(touch);
    const double recalled = recall_within(touch);
    for (int k = 0; k < touch.next.count; ++k) {
      const TouchPoint& point = touch.next.points[static_cast<std::size_t>(k)];
      if (point.separation > -deep || was_active(touch, point, recalled)) continue;
      first = std::min(first, impact_of(touch, point, time));
    }
  }
  return first;
}

// Flush faces swap their features at every rounding.
double FreeDrift::recall_within(const Touch& touch) const {
  return world_.stacked ? world_.tolerances.touching * bricks_.thinner(touch) : 0.0;
}

// The distance of one point at a moment of the drift.
double FreeDrift::distance_at(const Touch& touch, std::uint32_t feature, double time) const {
  Manifold manifold;
  manifold.axis = touch.now.axis;
  const Body a = body_at(static_cast<std::size_t>(touch.a), time);
  if (touch.b == kFloor) {
    touch_body(a, nullptr, 1e300, manifold);
  } else {
    const Body b = body_at(static_cast<std::size_t>(touch.b), time);
    touch_body(a, &b, 1e300, manifold);
  }
  if (manifold.count == 0) return manifold.parted;
  // Where faces are all but parallel a point may have another name now: then it is the nearest new one.
  const double near = world_.tolerances.touching * bricks_.thinner(touch), recalled = recall_within(touch);
  double least = 1e300;
  for (int k = 0; k < manifold.count; ++k) {
    const TouchPoint& point = manifold.points[static_cast<std::size_t>(k)];
    if (point.feature == feature) return point.separation;
    if (!has_touched(touch, point, recalled, near)) least = std::min(least, point.separation);
  }
  return least;
}

// The moment at which a point begins to touch that is deep after `time` of the drift.
double FreeDrift::impact_of(const Touch& touch, const TouchPoint& point, double time) const {
  const double thin = bricks_.thinner(touch), enough = world_.tolerances.located * thin;
  return impact_between(
      time, world_.tolerances.touching * thin, point.separation, [&](double moment) { return distance_at(touch, point.feature, moment); },
      [&](double distance) { return std::abs(distance) <= enough; });
}

// Points that have come to touch take part from now on. Returns whether there are any.
bool FreeDrift::activate_new_points() {
  bool any = false;
  for (Touch& touch : bricks_.touches) {
    if (touch.now.count == 0) continue;
    const double near = world_.tolerances.touching * bricks_.thinner(touch);
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

}  // namespace topple::rigid
