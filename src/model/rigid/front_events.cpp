// What happens inside a step: pushes, hits, arrivals, landings, rests.
#include <algorithm>
#include <cmath>
#include <limits>

#include "model/rigid/wavefront.h"

namespace topple::rigid {

namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

// The moment in a part of a step, as a share of it, at which a cosine that begins at c0 with slope d0 and ends at c1 with slope d1 passes
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

Event plain_event(EventKind kind, double time, BrickId brick, BrickId by) {
  return {.time = time,
          .kind = kind,
          .brick = brick,
          .by = by,
          .force = kNotANumber,
          .impulse = kNotANumber,
          .point = {kNotANumber, kNotANumber, kNotANumber}};
}

}  // namespace

void Front::note_arrival(std::size_t place, double begin, double time, double slope_before, double slope_after) {
  Member& member = members_[place];
  const double before = member.tilt_cosine;
  member.tilt_cosine = (bodies_[place].axes * member.local_up).z;
  std::uint8_t& arrived = world_.arrived[static_cast<std::size_t>(bodies_[place].id)];
  if (arrived != 0 || member.tilt_cosine > kArrivalCosine) return;
  arrived = 1;
  const double share = crossing(before, time * slope_before, member.tilt_cosine, time * slope_after, kArrivalCosine);
  events_.push_back(plain_event(EventKind::arrived, begin + share * time, bodies_[place].id, kNoBrick));
}

void Front::note_struck(double now) {
  for (const Struck& struck : struck_now_) {
    Event event = plain_event(EventKind::struck, now, struck.brick, struck.by);
    double impulse = 0.0;
    Vec3 point;
    Vec3 middle;
    int count = 0;
    for (const ContactRow& row : rows_) {
      if (row.b == kFloor) continue;
      const BrickId a = bodies_[static_cast<std::size_t>(row.a)].id, b = bodies_[static_cast<std::size_t>(row.b)].id;
      if (std::min(a, b) != std::min(struck.brick, struck.by) || std::max(a, b) != std::max(struck.brick, struck.by)) continue;
      const Vec3 at = bodies_[static_cast<std::size_t>(row.a)].position + row.arm_a;
      impulse += row.impulse[0];
      point = point + row.impulse[0] * at;
      middle = middle + at;
      ++count;
    }
    event.impulse = impulse;
    if (count > 0) event.point = impulse > 0.0 ? (1.0 / impulse) * point : (1.0 / count) * middle;
    events_.push_back(event);
  }
}

void Front::note_landed(double now) {
  for (const Touch& touch : touches_) {
    if (touch.b != kFloor) continue;
    Member& member = members_[static_cast<std::size_t>(touch.a)];
    if (member.landed) continue;
    const Body& body = bodies_[static_cast<std::size_t>(touch.a)];
    for (int k = 0; k < touch.now.count; ++k) {
      if (!touch.memory[static_cast<std::size_t>(k)].fresh) continue;
      const Vec3 arm = touch.now.points[static_cast<std::size_t>(k)].position - body.position;
      // A corner of what was its top.
      if (dot(arm, body.axes * member.local_up) <= 0.0) continue;
      member.landed = true;
      Event event = plain_event(EventKind::landed, now, body.id, kNoBrick);
      event.point = touch.now.points[static_cast<std::size_t>(k)].position;
      events_.push_back(event);
      break;
    }
  }
}

// The brick that carries most of another one, or none.
BrickId Front::supporter(int place) const {
  BrickId by = kNoBrick;
  double most = 0.0;
  for (const Touch& touch : touches_) {
    if (touch.b == kFloor || (touch.a != place && touch.b != place)) continue;
    const bool is_a = touch.a == place;
    const double lift = (is_a ? touch.now.normal.z : -touch.now.normal.z) * touch.impulse;
    if (lift <= most) continue;
    most = lift;
    by = bodies_[static_cast<std::size_t>(is_a ? touch.b : touch.a)].id;
  }
  return by;
}

void Front::note_rest(int place, double now) {
  const Body& body = bodies_[static_cast<std::size_t>(place)];
  Member& member = members_[static_cast<std::size_t>(place)];
  const Extents size = extents(world_.kinds[body.kind], world_.given(body.id).stance);
  const bool fallen = member.tilt_cosine < std::cos(tip_angle(size));
  const BrickId by = supporter(place);
  if (fallen && !member.landed) {
    member.landed = true;
    events_.push_back(plain_event(EventKind::landed, now, body.id, by));
  }
  const BrickId next = next_of_part(world_.layout, body.id);
  if (fallen && by == kNoBrick && next != kNoBrick && world_.phase[static_cast<std::size_t>(next)] == Phase::standing && !moves(next)) {
    events_.push_back(plain_event(EventKind::missed, now, body.id, next));
  }
  events_.push_back(plain_event(EventKind::rested, now, body.id, by));
}

// Of a brick that has been given a velocity: the points that do not part go on to touch.
void Front::keep_what_stays(Touch& touch) const {
  const double slow = 0.5 * world_.gravity * world_.step;
  for (int k = 0; k < touch.now.count; ++k) {
    PointMemory& memory = touch.memory[static_cast<std::size_t>(k)];
    memory = memory.active && -closing_speed(touch, k) <= slow ? kTouching : PointMemory{};
  }
}

void Front::begin_push(const Push& push, double now) {
  const int place = place_of(push.brick);
  Body& body = bodies_[static_cast<std::size_t>(place)];
  const Extents size = extents(world_.kinds[body.kind], world_.given(push.brick).stance);
  const Pose put_down = world_.standing(push.brick);
  const SinCos turn = sin_cos(world_.heading(push.brick));
  const Vec3 heading{turn.cos, turn.sin, 0.0};
  const Quat back = conjugate(put_down.orientation);
  const double before = kinetic_energy(body);
  Event event = plain_event(EventKind::pushed, now, push.brick, kNoBrick);
  members_[static_cast<std::size_t>(place)].quiet = 0.0;
  if (const auto* spin = std::get_if<AngularSpeedPush>(&push.how)) {
    const Vec3 local_toe = rotate(back, (0.5 * size.along) * heading - Vec3{0.0, 0.0, 0.5 * size.up});
    body.angular_velocity = spin->angular_speed * Vec3{-heading.y, heading.x, 0.0};
    body.velocity = -cross(body.angular_velocity, body.axes * local_toe);
    refresh(body);
    ledger_.push_work += kinetic_energy(body) - before;
    for (Touch& touch : touches_) {
      if (touch.a == place || touch.b == place) keep_what_stays(touch);
    }
  } else if (const auto* force = std::get_if<ForcePush>(&push.how)) {
    const Vec3 local = rotate(back, Vec3{0.0, 0.0, force->height - 0.5 * size.up} - (0.5 * size.along) * heading);
    forces_.push_back({push.brick, force->force * heading, local, push.at + force->duration});
    members_[static_cast<std::size_t>(place)].pushed = true;
    event.force = force->force;
    event.point = body.position + body.axes * local;
  } else {
    const auto& shove = std::get<ImpulsePush>(push.how);
    const Vec3 local = rotate(back, Vec3{0.0, 0.0, shove.height - 0.5 * size.up} - (0.5 * size.along) * heading);
    const Vec3 arm = body.axes * local;
    const Vec3 impulse = shove.impulse * heading;
    const Vec3 speed_before = velocity_at(body, arm);
    body.velocity = body.velocity + body.inverse_mass * impulse;
    body.angular_velocity = body.angular_velocity + body.inverse_inertia * cross(arm, impulse);
    blow(true);
    // Work of a blow: the impulse times the mean velocity of its point, before and after.
    ledger_.push_work += 0.5 * dot(impulse, speed_before + velocity_at(bodies_[static_cast<std::size_t>(place)], arm));
    event.impulse = shove.impulse;
    event.point = body.position + arm;
  }
  events_.push_back(event);
}

void Front::add_to(Hash& hash) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!members_[i].moving && !members_[i].just_rested) continue;
    const Body& body = bodies_[i];
    hash.add(static_cast<std::uint64_t>(body.id));
    for (const Vec3* v : {&body.position, &body.velocity, &body.angular_velocity}) {
      hash.add(v->x);
      hash.add(v->y);
      hash.add(v->z);
    }
    hash.add(body.orientation.w);
    hash.add(body.orientation.x);
    hash.add(body.orientation.y);
    hash.add(body.orientation.z);
  }
}

BrickId Front::not_finite() const {
  for (const Body& body : bodies_) {
    const Vec3 sum = body.position + body.velocity + body.angular_velocity;
    const Quat& q = body.orientation;
    if (!std::isfinite(sum.x + sum.y + sum.z) || !std::isfinite(q.w + q.x + q.y + q.z)) return body.id;
  }
  return kNoBrick;
}

std::size_t Front::motion_count() const {
  return static_cast<std::size_t>(
      std::count_if(members_.begin(), members_.end(), [](const Member& member) { return member.moving || member.just_rested; }));
}

void Front::read(std::span<FreeMotion> out, Energy* energy) const {
  std::size_t next = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!members_[i].moving && !members_[i].just_rested) continue;
    const Body& body = bodies_[i];
    out[next++] = {body.id,
                   members_[i].moving ? Phase::falling : Phase::resting,
                   {body.position, body.orientation},
                   body.velocity,
                   body.angular_velocity};
    if (!members_[i].moving) continue;
    if (energy == nullptr) continue;
    energy->kinetic += kinetic_energy(body);
    energy->potential += potential_energy(world_, body.id, body.position.z);
  }
}

void Front::read(std::vector<Contact>& out) const {
  for (const Touch& touch : touches_) {
    const Body& a = bodies_[static_cast<std::size_t>(touch.a)];
    const Body* b = touch.b == kFloor ? nullptr : &bodies_[static_cast<std::size_t>(touch.b)];
    if (a.inverse_mass == 0.0 && (b == nullptr || b->inverse_mass == 0.0)) continue;
    for (std::size_t k = 0; k < static_cast<std::size_t>(touch.now.count); ++k) {
      const PointMemory& memory = touch.memory[k];
      if (!memory.active || memory.normal_force <= 0.0) continue;
      out.push_back({a.id, b == nullptr ? kNoBrick : b->id, touch.now.points[k].position,
                     memory.normal_force * touch.now.normal + memory.friction_force});
    }
  }
}

}  // namespace topple::rigid
