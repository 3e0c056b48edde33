// What happens inside a step of a plane front: pushes, hits, arrivals, landings, rests; and what others read of it.
#include <algorithm>
#include <cmath>

#include "base/trigonometry.h"
#include "model/rigid/plane_front.h"

namespace topple::rigid {

// Of the drift under way, up to so long after it began.
void PlaneFront::note_arrivals(double until) {
  for (const PlaneBrick& brick : state_.bricks) {
    if (!brick.moving) continue;
    const double rate = brick.velocity.turn, gain = (brick.middle.turn - brick.velocity.turn) / drift_.whole();
    const auto turn_at = [&](double t) { return brick.box.place.turn + t * (rate + t * gain); };
    if (std::abs(turn_at(until)) < kArrivalTilt) continue;
    if (world_.arrived[static_cast<std::size_t>(brick.id)] != 0) continue;
    // Between the ends of the drift, not of the step: so it does not depend on where in a step it is.
    double low = 0.0, high = drift_.cut();
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (std::abs(turn_at(middle)) < kArrivalTilt ? low : high) = middle;
    }
    tell_arrival(brick.id, now_ + high);
    if (even_row_.strikes() > 0) cycle_.add_arrival(brick.id, high);
  }
}

void PlaneFront::note_struck(double now) {
  for (const Struck& struck : struck_now_) {
    Event event = plain_event(EventKind::struck, now, struck.brick, struck.by);
    double impulse = 0.0, x = 0.0, z = 0.0, middle_x = 0.0, middle_z = 0.0;
    int count = 0;
    for (const PlaneRow& row : impulses_.rows()) {
      const PlaneTouch& touch = state_.touch(row.touch);
      if (touch.b < 0) continue;
      const BrickId a = state_.brick(touch.a).id, b = state_.brick(touch.b).id;
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
    if (count > 0)
      event.point = impulse > 0.0 ? in_world(plane_, x / impulse, z / impulse) : in_world(plane_, middle_x / count, middle_z / count);
    ledger_.events.push_back(event);
  }
}

void PlaneFront::note_landed(double now) {
  for (const int pair : state_.near_pairs) {
    const PlaneTouch& touch = state_.touch(pair);
    if (touch.b >= 0) continue;
    PlaneBrick& brick = state_.brick(touch.a);
    if (brick.landed) continue;
    for (int k = 0; k < touch.now.count; ++k) {
      // A corner of what was its top.
      if (!touch.memory[static_cast<std::size_t>(k)].fresh || (touch.now.points[static_cast<std::size_t>(k)].feature & 2U) == 0) continue;
      brick.landed = true;
      Event event = plain_event(EventKind::landed, now, brick.id, kNoBrick);
      event.point = in_world(plane_, touch.now.points[static_cast<std::size_t>(k)].x, touch.now.points[static_cast<std::size_t>(k)].z);
      ledger_.events.push_back(event);
      break;
    }
  }
}

// The brick that carries most of another one, or none.
BrickId PlaneFront::supporter(int place) const {
  BrickId by = kNoBrick;
  double most = 0.0;
  for (const PlaneTouch& touch : state_.touches) {
    if (touch.b < 0 || (touch.a != place && touch.b != place)) continue;
    const double lift = (touch.a == place ? 1.0 : -1.0) * touch.now.normal_z * touch.impulse;
    if (lift <= most) continue;
    most = lift;
    by = state_.brick(touch.a == place ? touch.b : touch.a).id;
  }
  return by;
}

void PlaneFront::note_rest(int place, double now) {
  PlaneBrick& brick = state_.brick(place);
  const bool fallen = std::abs(brick.box.place.turn) > tip_angle({2.0 * brick.box.half_along, 0.0, 2.0 * brick.box.half_up});
  tell_rest(brick.id, fallen, brick.landed, supporter(place), now);
  brick.landed = brick.landed || fallen;
}

// All that the end of a drift does that is not computed again.
void PlaneFront::tell_end(const PlaneCycle::Drift& drift) {
  const BrickId first = state_.last_struck;
  for (const int brick : drift.woken) ledger_.woken.push_back(first + brick);
  for (const int brick : drift.taken) ledger_.take(first + brick);
  for (const int brick : drift.left) ledger_.leave(first + brick);
  for (const PlaneCycle::Move& move : drift.moves) {
    ledger_.moves.push_back({first + move.brick, in_world(plane_, move.from.x, move.from.z), in_world(plane_, move.to.x, move.to.z)});
  }
  for (const PlaneBrick& numbered : drift.rested) {
    PlaneBrick& brick = rested_now_.emplace_back(numbered);
    brick.id += first;
    ledger_.rested.push_back({brick.id, pose_of(plane_, world_, brick)});
    if (repeat_.is_unseen(brick.id)) echoes_.push_back(repeat_.echo_of(brick.id));
  }
  for (const PlaneCycle::Happening& happening : drift.events) {
    Event& event = ledger_.events.emplace_back(happening.event);
    event.time = now_;
    event.brick += first;
    event.by = happening.by_floor ? kNoBrick : event.by + first;
    if (happening.somewhere) event.point = in_world(plane_, event.point.x, event.point.z);
  }
}

// Of a brick that has been given a velocity: the points that do not part go on to touch.
void PlaneFront::keep_what_stays(PlaneTouch& touch, int place) const {
  const PlaneBrick& brick = state_.brick(place);
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
  const int place = members_.place_of(push.brick);
  PlaneBrick& brick = state_.brick(place);
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
    for (PlaneTouch& touch : state_.touches) {
      if (touch.a == place || touch.b == place) keep_what_stays(touch, place);
    }
  } else if (const auto* force = std::get_if<ForcePush>(&push.how)) {
    state_.forces.push_back({push.brick, way * force->force, -way * along, force->height - up, push.at + force->duration});
    brick.pushed = true;
    event.force = force->force;
    const PlaneVec at = arm(-way * along, force->height - up);
    event.point = in_world(plane_, brick.box.place.x + at.x, brick.box.place.z + at.z);
  } else {
    const auto& blow = std::get<ImpulsePush>(push.how);
    const PlaneVec at = arm(-way * along, blow.height - up);
    const double impulse = way * blow.impulse;
    const double speed_before = brick.velocity.x + brick.velocity.turn * at.z;
    brick.velocity.x += impulse / brick.mass;
    brick.velocity.turn += impulse * at.z / brick.inertia;
    impulses_.blow(true);
    const PlaneBrick& pushed = state_.brick(place);
    // Work of a blow: the impulse times the mean velocity of its point, before and after.
    ledger_.push_work += 0.5 * impulse * (speed_before + pushed.velocity.x + pushed.velocity.turn * at.z);
    event.impulse = blow.impulse;
    event.point = in_world(plane_, pushed.box.place.x + at.x, pushed.box.place.z + at.z);
  }
  ledger_.events.push_back(event);
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
    if (!drift_.is_under_way()) return add(brick, place, velocity);
    const double time = drift_.done(), whole = drift_.whole();
    add(brick, place + time * velocity + (time * time / whole) * (middle - velocity),
        velocity + (2.0 * time / whole) * (middle - velocity));
  };
  if (repeat_.is_on()) {
    for (const PlaneCycle::Place& p : repeat_.drift().places) add_moving(state_.last_struck + p.brick, p.place, p.velocity, p.middle);
    return;
  }
  for (const PlaneBrick& brick : state_.bricks) {
    if (brick.moving) add_moving(brick.id, brick.box.place, brick.velocity, brick.middle);
  }
}

BrickId PlaneFront::not_finite() const {
  for (const PlaneBrick& brick : state_.bricks) {
    const PlaneVec sum = brick.box.place + brick.velocity;
    if (!std::isfinite(sum.x + sum.z + sum.turn)) return brick.id;
  }
  return kNoBrick;
}

std::size_t PlaneFront::motion_count() const {
  std::size_t count = 0;
  for (const PlaneBrick& brick : rested_now_) count += repeat_.is_unseen(brick.id) ? 0 : 1;
  if (repeat_.is_on()) {
    for (const PlaneCycle::Place& place : repeat_.drift().places) count += repeat_.is_unseen(state_.last_struck + place.brick) ? 0 : 1;
    return count;
  }
  for (const PlaneBrick& brick : state_.bricks) count += brick.moving ? 1 : 0;
  return count;
}

void PlaneFront::read(std::span<FreeMotion> out, Energy* energy) const {
  std::size_t next = 0;
  for (const PlaneBrick& brick : rested_now_) {
    if (!repeat_.is_unseen(brick.id)) out[next++] = {brick.id, Phase::resting, pose_of(plane_, world_, brick), {}, {}};
  }
  const auto tell = [&](const PlaneBrick& brick) {
    if (!repeat_.is_unseen(brick.id)) out[next++] = motion_of(plane_, world_, brick, Phase::falling);
    if (energy == nullptr) return;
    energy->kinetic += kinetic_energy(brick, brick.velocity);
    energy->potential += potential_energy(world_, brick.id, brick.box.place.z);
  };
  if (repeat_.is_on()) {
    for (const PlaneCycle::Place& place : repeat_.drift().places) {
      if (energy != nullptr || !repeat_.is_unseen(state_.last_struck + place.brick)) tell(drift_.by_now(repeat_.brick_of(place)));
    }
    return;
  }
  for (const PlaneBrick& brick : state_.bricks) {
    if (brick.moving) tell(drift_.by_now(brick));
  }
}

void PlaneFront::read(std::vector<Contact>& out) const {
  for (const PlaneTouch& touch : state_.touches) {
    const PlaneBrick& a = state_.brick(touch.a);
    const PlaneBrick* b = touch.b < 0 ? nullptr : &state_.brick(touch.b);
    if (!a.moving && (b == nullptr || !b->moving)) continue;
    const PlaneManifold by_now = drift_.by_now(touch);
    const Vec3 normal = by_now.normal_x * plane_.along + Vec3{0.0, 0.0, by_now.normal_z};
    const Vec3 tangent = by_now.normal_z * plane_.along + Vec3{0.0, 0.0, -by_now.normal_x};
    for (std::size_t k = 0; k < static_cast<std::size_t>(touch.now.count); ++k) {
      const PlaneMemory& memory = touch.memory[k];
      const double pressure = memory.normal + memory.leaning;
      if (!memory.active || pressure <= 0.0) continue;
      const PlanePoint& point = by_now.points[k];
      out.push_back({a.id, b == nullptr ? kNoBrick : b->id, in_world(plane_, point.x, point.z),
                     pressure * normal + (memory.tangent + memory.leaning_tangent) * tangent});
    }
  }
}

}  // namespace topple::rigid
