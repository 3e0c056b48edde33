// What happens inside a step: pushes, hits, arrivals, landings, rests.
#include <algorithm>
#include <cmath>

#include "model/rigid/free_front.h"

namespace topple::rigid {

namespace {}  // namespace

void FreeFront::note_struck(double now) {
  for (const Struck& struck : struck_now_) {
    Event event = plain_event(EventKind::struck, now, struck.brick, struck.by);
    double impulse = 0.0;
    Vec3 point;
    Vec3 middle;
    int count = 0;
    for (const ContactRow& row : impulses_.rows()) {
      if (row.b == kFloor) continue;
      const BrickId a = bricks_.body(row.a).id, b = bricks_.body(row.b).id;
      if (std::min(a, b) != std::min(struck.brick, struck.by) || std::max(a, b) != std::max(struck.brick, struck.by)) continue;
      const Vec3 at = bricks_.body(row.a).position + row.arm_a;
      impulse += row.impulse[0];
      point = point + row.impulse[0] * at;
      middle = middle + at;
      ++count;
    }
    event.impulse = impulse;
    if (count > 0) event.point = impulse > 0.0 ? (1.0 / impulse) * point : (1.0 / count) * middle;
    ledger_.events.push_back(event);
  }
}

void FreeFront::note_landed(double now) {
  for (const Touch& touch : bricks_.touches) {
    if (touch.b != kFloor) continue;
    Member& member = bricks_.member(touch.a);
    if (member.landed) continue;
    const Body& body = bricks_.body(touch.a);
    for (int k = 0; k < touch.now.count; ++k) {
      if (!touch.memory[static_cast<std::size_t>(k)].fresh) continue;
      const Vec3 arm = touch.now.points[static_cast<std::size_t>(k)].position - body.position;
      // A corner of what was its top.
      if (dot(arm, body.axes * member.local_up) <= 0.0) continue;
      member.landed = true;
      Event event = plain_event(EventKind::landed, now, body.id, kNoBrick);
      event.point = touch.now.points[static_cast<std::size_t>(k)].position;
      ledger_.events.push_back(event);
      break;
    }
  }
}

// The brick that carries most of another one, or none.
BrickId FreeFront::supporter(int place) const {
  BrickId by = kNoBrick;
  double most = 0.0;
  for (const Touch& touch : bricks_.touches) {
    if (touch.b == kFloor || (touch.a != place && touch.b != place)) continue;
    const bool is_a = touch.a == place;
    const double lift = (is_a ? touch.now.normal.z : -touch.now.normal.z) * touch.impulse;
    if (lift <= most) continue;
    most = lift;
    by = bricks_.body(is_a ? touch.b : touch.a).id;
  }
  return by;
}

void FreeFront::note_rest(int place, double now) {
  const Body& body = bricks_.body(place);
  Member& member = bricks_.member(place);
  const Extents size = extents(world_.kinds[body.kind], world_.given(body.id).stance);
  const bool fallen = member.tilt_cosine < std::cos(tip_angle(size));
  tell_rest(body.id, fallen, member.landed, supporter(place), now);
  member.landed = member.landed || fallen;
}

// Of a brick that has been given a velocity: the points that do not part go on to touch.
void FreeFront::keep_what_stays(Touch& touch) const {
  const double slow = 0.5 * world_.gravity * world_.step;
  for (int k = 0; k < touch.now.count; ++k) {
    PointMemory& memory = touch.memory[static_cast<std::size_t>(k)];
    memory = memory.active && -bricks_.closing_speed(touch, k) <= slow ? kTouching : PointMemory{};
  }
}

void FreeFront::begin_push(const Push& push, double now) {
  const int place = members_.place_of(push.brick);
  Body& body = bricks_.body(place);
  const Extents size = extents(world_.kinds[body.kind], world_.given(push.brick).stance);
  const Pose put_down = world_.standing(push.brick);
  const SinCos turn = sin_cos(world_.heading(push.brick));
  const Vec3 heading{turn.cos, turn.sin, 0.0};
  const Quat back = conjugate(put_down.orientation);
  const double before = kinetic_energy(body);
  Event event = plain_event(EventKind::pushed, now, push.brick, kNoBrick);
  bricks_.member(place).quiet = 0.0;
  if (const auto* spin = std::get_if<AngularSpeedPush>(&push.how)) {
    const Vec3 local_toe = rotate(back, (0.5 * size.along) * heading - Vec3{0.0, 0.0, 0.5 * size.up});
    body.angular_velocity = spin->angular_speed * Vec3{-heading.y, heading.x, 0.0};
    body.velocity = -cross(body.angular_velocity, body.axes * local_toe);
    refresh(body);
    ledger_.push_work += kinetic_energy(body) - before;
    for (Touch& touch : bricks_.touches) {
      if (touch.a == place || touch.b == place) keep_what_stays(touch);
    }
  } else if (const auto* force = std::get_if<ForcePush>(&push.how)) {
    const Vec3 local = rotate(back, Vec3{0.0, 0.0, force->height - 0.5 * size.up} - (0.5 * size.along) * heading);
    bricks_.forces.push_back({push.brick, force->force * heading, local, push.at + force->duration});
    bricks_.member(place).pushed = true;
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
    impulses_.blow(true);
    // Work of a blow: the impulse times the mean velocity of its point, before and after.
    ledger_.push_work += 0.5 * dot(impulse, speed_before + velocity_at(bricks_.body(place), arm));
    event.impulse = shove.impulse;
    event.point = body.position + arm;
  }
  ledger_.events.push_back(event);
}

void FreeFront::add_to(Hash& hash) const {
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    if (!bricks_.members[i].moving && !bricks_.members[i].just_rested) continue;
    const Body& body = bricks_.bodies[i];
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

BrickId FreeFront::not_finite() const {
  for (const Body& body : bricks_.bodies) {
    const Vec3 sum = body.position + body.velocity + body.angular_velocity;
    const Quat& q = body.orientation;
    if (!std::isfinite(sum.x + sum.y + sum.z) || !std::isfinite(q.w + q.x + q.y + q.z)) return body.id;
  }
  return kNoBrick;
}

std::size_t FreeFront::motion_count() const {
  return static_cast<std::size_t>(std::count_if(bricks_.members.begin(), bricks_.members.end(),
                                                [](const Member& member) { return member.moving || member.just_rested; }));
}

void FreeFront::read(std::span<FreeMotion> out, Energy* energy) const {
  std::size_t next = 0;
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    if (!bricks_.members[i].moving && !bricks_.members[i].just_rested) continue;
    const Body& body = bricks_.bodies[i];
    out[next++] = {body.id,
                   bricks_.members[i].moving ? Phase::falling : Phase::resting,
                   {body.position, body.orientation},
                   body.velocity,
                   body.angular_velocity};
    if (!bricks_.members[i].moving) continue;
    if (energy == nullptr) continue;
    energy->kinetic += kinetic_energy(body);
    energy->potential += potential_energy(world_, body.id, body.position.z);
  }
}

void FreeFront::read(std::vector<Contact>& out) const {
  for (const Touch& touch : bricks_.touches) {
    const Body& a = bricks_.body(touch.a);
    const Body* b = bricks_.second(touch);
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
