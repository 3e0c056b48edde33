// What happens inside a step of a plane front: pushes, hits, arrivals, landings, rests; and what others read of it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/trigonometry.h"
#include "model/rigid/plane_front.h"

namespace topple::rigid {

namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

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

// Of the drift under way, up to so long after it began.
void PlaneFront::note_arrivals(double until) {
  for (const PlaneBrick& brick : bricks_) {
    if (!brick.moving) continue;
    const double rate = brick.velocity.turn, gain = (brick.middle.turn - brick.velocity.turn) / drift_.whole;
    const auto turn_at = [&](double t) { return brick.box.place.turn + t * (rate + t * gain); };
    if (std::abs(turn_at(until)) < kArrivalTilt) continue;
    if (world_.arrived[static_cast<std::size_t>(brick.id)] != 0) continue;
    // Between the ends of the drift, not of the step: so it does not depend on where in a step it is.
    double low = 0.0, high = drift_.cut;
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (std::abs(turn_at(middle)) < kArrivalTilt ? low : high) = middle;
    }
    note_arrival(brick.id, now_ + high);
    if (even_ > 0) cycle_.drifts[cycle_.count - 1].arrivals.push_back({brick.id - last_struck_, high});
  }
}

void PlaneFront::note_arrival(BrickId brick, double time) {
  world_.arrived[static_cast<std::size_t>(brick)] = 1;
  events_.push_back(plain_event(EventKind::arrived, time, brick, kNoBrick));
}

void PlaneFront::note_struck(double now) {
  for (const Struck& struck : struck_now_) {
    Event event = plain_event(EventKind::struck, now, struck.brick, struck.by);
    double impulse = 0.0, x = 0.0, z = 0.0, middle_x = 0.0, middle_z = 0.0;
    int count = 0;
    for (const PlaneRow& row : rows_) {
      const PlaneTouch& touch = touches_[static_cast<std::size_t>(row.touch)];
      if (touch.b < 0) continue;
      const BrickId a = bricks_[static_cast<std::size_t>(touch.a)].id, b = bricks_[static_cast<std::size_t>(touch.b)].id;
      if (std::min(a, b) != std::min(struck.brick, struck.by) || std::max(a, b) != std::max(struck.brick, struck.by)) continue;
      const PlanePoint& point = touch.now.points[static_cast<std::size_t>(row.point)];
      impulse += row.normal;
      x += row.normal * point.x;
      z += row.normal * point.z;
      middle_x += point.x;
      middle_z += point.z;
      ++count;
    }
    event.impulse = impulse;
    if (count > 0) event.point = impulse > 0.0 ? in_world(x / impulse, z / impulse) : in_world(middle_x / count, middle_z / count);
    events_.push_back(event);
  }
}

void PlaneFront::note_landed(double now) {
  for (const int pair : near_pairs_) {
    const PlaneTouch& touch = touches_[static_cast<std::size_t>(pair)];
    if (touch.b >= 0) continue;
    PlaneBrick& brick = bricks_[static_cast<std::size_t>(touch.a)];
    if (brick.landed) continue;
    for (int k = 0; k < touch.now.count; ++k) {
      // A corner of what was its top.
      if (!touch.memory[static_cast<std::size_t>(k)].fresh || (touch.now.points[static_cast<std::size_t>(k)].feature & 2U) == 0) continue;
      brick.landed = true;
      Event event = plain_event(EventKind::landed, now, brick.id, kNoBrick);
      event.point = in_world(touch.now.points[static_cast<std::size_t>(k)].x, touch.now.points[static_cast<std::size_t>(k)].z);
      events_.push_back(event);
      break;
    }
  }
}

// The brick that carries most of another one, or none.
BrickId PlaneFront::supporter(int place) const {
  BrickId by = kNoBrick;
  double most = 0.0;
  for (const PlaneTouch& touch : touches_) {
    if (touch.b < 0 || (touch.a != place && touch.b != place)) continue;
    const double lift = (touch.a == place ? 1.0 : -1.0) * touch.now.normal_z * touch.impulse;
    if (lift <= most) continue;
    most = lift;
    by = bricks_[static_cast<std::size_t>(touch.a == place ? touch.b : touch.a)].id;
  }
  return by;
}

void PlaneFront::note_rest(int place, double now) {
  PlaneBrick& brick = bricks_[static_cast<std::size_t>(place)];
  const Extents size{2.0 * brick.box.half_along, 0.0, 2.0 * brick.box.half_up};
  const bool fallen = std::abs(brick.box.place.turn) > tip_angle(size);
  const BrickId by = supporter(place);
  if (fallen && !brick.landed) {
    brick.landed = true;
    events_.push_back(plain_event(EventKind::landed, now, brick.id, by));
  }
  const BrickId next = next_of_part(world_.layout, brick.id);
  if (fallen && by == kNoBrick && next != kNoBrick && world_.phase[static_cast<std::size_t>(next)] == Phase::standing && !moves(next)) {
    events_.push_back(plain_event(EventKind::missed, now, brick.id, next));
  }
  events_.push_back(plain_event(EventKind::rested, now, brick.id, by));
}

// Of a brick that has been given a velocity: the points that do not part go on to touch.
void PlaneFront::keep_what_stays(PlaneTouch& touch, int place) const {
  const PlaneBrick& brick = bricks_[static_cast<std::size_t>(place)];
  const double side = touch.a == place ? 1.0 : -1.0, slow = 0.5 * world_.gravity * world_.step;
  for (int k = 0; k < touch.now.count; ++k) {
    const PlanePoint& point = touch.now.points[static_cast<std::size_t>(k)];
    const Column<3> j =
        rate(side * touch.now.normal_x, side * touch.now.normal_z, point.x - brick.box.place.x, point.z - brick.box.place.z);
    PlaneMemory& memory = touch.memory[static_cast<std::size_t>(k)];
    memory = {.active = memory.active && product_of(j, brick.velocity) <= slow};
  }
}

void PlaneFront::begin_push(const Push& push, double now) {
  const int place = place_of(push.brick);
  PlaneBrick& brick = bricks_[static_cast<std::size_t>(place)];
  const SinCos turn = sin_cos(world_.heading(push.brick));
  const double way = turn.cos * plane_.along.x + turn.sin * plane_.along.y > 0.0 ? 1.0 : -1.0;
  const double along = brick.box.half_along, up = brick.box.half_up;
  const double before = kinetic_energy(brick, brick.velocity);
  const auto arm = [&brick](double x, double z) {
    return PlaneVec{x * brick.box.cosine + z * brick.box.sine, z * brick.box.cosine - x * brick.box.sine, 0.0};
  };
  Event event = plain_event(EventKind::pushed, now, push.brick, kNoBrick);
  brick.quiet = 0.0;
  if (const auto* spin = std::get_if<AngularSpeedPush>(&push.how)) {
    const PlaneVec toe = arm(way * along, -up);
    const double speed = way * spin->angular_speed;
    brick.velocity = {-speed * toe.z, speed * toe.x, speed};
    ledger_.push_work += kinetic_energy(brick, brick.velocity) - before;
    for (PlaneTouch& touch : touches_) {
      if (touch.a == place || touch.b == place) keep_what_stays(touch, place);
    }
  } else if (const auto* force = std::get_if<ForcePush>(&push.how)) {
    forces_.push_back({push.brick, way * force->force, -way * along, force->height - up, push.at + force->duration});
    brick.pushed = true;
    event.force = force->force;
    const PlaneVec at = arm(-way * along, force->height - up);
    event.point = in_world(brick.box.place.x + at.x, brick.box.place.z + at.z);
  } else {
    const auto& blow = std::get<ImpulsePush>(push.how);
    const PlaneVec at = arm(-way * along, blow.height - up);
    const double impulse = way * blow.impulse;
    const double speed_before = brick.velocity.x + brick.velocity.turn * at.z;
    brick.velocity.x += impulse / brick.mass;
    brick.velocity.turn += impulse * at.z / brick.inertia;
    this->blow(true);
    const PlaneBrick& pushed = bricks_[static_cast<std::size_t>(place)];
    // Work of a blow: the impulse times the mean velocity of its point, before and after.
    ledger_.push_work += 0.5 * impulse * (speed_before + pushed.velocity.x + pushed.velocity.turn * at.z);
    event.impulse = blow.impulse;
    event.point = in_world(pushed.box.place.x + at.x, pushed.box.place.z + at.z);
  }
  events_.push_back(event);
}

// A brick as it is by now, amid the drift.
PlaneBrick PlaneFront::at_this_moment(const PlaneBrick& brick) const {
  PlaneBrick out = brick;
  if (!drift_.under_way || !brick.moving) return out;
  out.box = box_at(brick, drift_.done, drift_.whole);
  out.velocity = brick.velocity + (2.0 * drift_.done / drift_.whole) * (brick.middle - brick.velocity);
  return out;
}

void PlaneFront::add_to(Hash& hash) const {
  const auto add = [&hash](BrickId brick, const PlaneVec& place, const PlaneVec& velocity) {
    hash.add(static_cast<std::uint64_t>(brick));
    for (const PlaneVec& v : {place, velocity}) {
      hash.add(v.x);
      hash.add(v.z);
      hash.add(v.turn);
    }
  };
  for (const PlaneBrick& brick : rested_now_) add(brick.id, brick.box.place, brick.velocity);
  const auto add_moving = [&](BrickId brick, const PlaneVec& place, const PlaneVec& velocity, const PlaneVec& middle) {
    if (!drift_.under_way) return add(brick, place, velocity);
    const double time = drift_.done, whole = drift_.whole;
    add(brick, place + time * velocity + (time * time / whole) * (middle - velocity),
        velocity + (2.0 * time / whole) * (middle - velocity));
  };
  if (repeat_.on) {
    for (const PlaneCycle::Place& p : cycle_.drifts[repeat_.drift].places)
      add_moving(last_struck_ + p.brick, p.place, p.velocity, p.middle);
    return;
  }
  for (const PlaneBrick& brick : bricks_) {
    if (brick.moving) add_moving(brick.id, brick.box.place, brick.velocity, brick.middle);
  }
}

BrickId PlaneFront::not_finite() const {
  for (const PlaneBrick& brick : bricks_) {
    const PlaneVec sum = brick.box.place + brick.velocity;
    if (!std::isfinite(sum.x + sum.z + sum.turn)) return brick.id;
  }
  return kNoBrick;
}

std::size_t PlaneFront::motion_count() const {
  std::size_t count = 0;
  for (const PlaneBrick& brick : rested_now_) count += is_unseen(brick.id) ? 0 : 1;
  if (repeat_.on) {
    for (const PlaneCycle::Place& place : cycle_.drifts[repeat_.drift].places) count += is_unseen(last_struck_ + place.brick) ? 0 : 1;
    return count;
  }
  for (const PlaneBrick& brick : bricks_) count += brick.moving ? 1 : 0;
  return count;
}

void PlaneFront::read(std::span<FreeMotion> out, Energy* energy) const {
  std::size_t next = 0;
  for (const PlaneBrick& brick : rested_now_) {
    if (!is_unseen(brick.id)) out[next++] = {brick.id, Phase::resting, pose_of(brick), {}, {}};
  }
  const auto tell = [&](const PlaneBrick& brick) {
    const PlaneVec& v = brick.velocity;
    if (!is_unseen(brick.id)) {
      out[next++] = {brick.id, Phase::falling, pose_of(brick), v.x * plane_.along + Vec3{0.0, 0.0, v.z}, v.turn * plane_.across};
    }
    if (energy == nullptr) return;
    energy->kinetic += kinetic_energy(brick, brick.velocity);
    energy->potential += potential_energy(world_, brick.id, brick.box.place.z);
  };
  if (repeat_.on) {
    for (const PlaneCycle::Place& place : cycle_.drifts[repeat_.drift].places) {
      if (energy != nullptr || !is_unseen(last_struck_ + place.brick)) tell(at_this_moment(place));
    }
    return;
  }
  for (const PlaneBrick& brick : bricks_) {
    if (brick.moving) tell(at_this_moment(brick));
  }
}

// Where the points of a drift's beginning are by now.
PlaneManifold PlaneFront::at_this_moment(const PlaneTouch& touch) const {
  PlaneManifold by_now = touch.now, moved;
  moved.axis = touch.now.axis;
  const PlaneBox a = at_this_moment(bricks_[static_cast<std::size_t>(touch.a)]).box;
  const double far = touch.thin;
  if (touch.b < 0) {
    touch_floor(a, far, moved);
  } else {
    touch_boxes(a, at_this_moment(bricks_[static_cast<std::size_t>(touch.b)]).box, far, moved);
  }
  bool same = moved.count > 0;
  for (std::size_t k = 0; same && k < static_cast<std::size_t>(touch.now.count); ++k) {
    const auto end = moved.points.begin() + moved.count;
    const auto found =
        std::find_if(moved.points.begin(), end, [&](const PlanePoint& p) { return p.feature == touch.now.points[k].feature; });
    same = found != end;
    if (same) by_now.points[k] = *found;
  }
  if (!same) return touch.now;
  by_now.normal_x = moved.normal_x;
  by_now.normal_z = moved.normal_z;
  return by_now;
}

void PlaneFront::read(std::vector<Contact>& out) const {
  for (const PlaneTouch& touch : touches_) {
    const PlaneBrick& a = bricks_[static_cast<std::size_t>(touch.a)];
    const PlaneBrick* b = touch.b < 0 ? nullptr : &bricks_[static_cast<std::size_t>(touch.b)];
    if (!a.moving && (b == nullptr || !b->moving)) continue;
    const PlaneManifold by_now = at_this_moment(touch);
    const Vec3 normal = by_now.normal_x * plane_.along + Vec3{0.0, 0.0, by_now.normal_z};
    const Vec3 tangent = by_now.normal_z * plane_.along + Vec3{0.0, 0.0, -by_now.normal_x};
    for (std::size_t k = 0; k < static_cast<std::size_t>(touch.now.count); ++k) {
      const PlaneMemory& memory = touch.memory[k];
      const double pressure = memory.normal + memory.leaning;
      if (!memory.active || pressure <= 0.0) continue;
      const PlanePoint& point = by_now.points[k];
      out.push_back({a.id, b == nullptr ? kNoBrick : b->id, in_world(point.x, point.z),
                     pressure * normal + (memory.tangent + memory.leaning_tangent) * tangent});
    }
  }
}

}  // namespace topple::rigid
