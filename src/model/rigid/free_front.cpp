#include "model/rigid/free_front.h"

#include <algorithm>
#include <cmath>

namespace topple::rigid {

namespace {

// How far the farthest corner may have moved [m].
double displacement(const Body& body, const Vec3& position, const Quat& orientation) {
  const Quat& q = body.orientation;
  const double same = q.w * orientation.w + q.x * orientation.x + q.y * orientation.y + q.z * orientation.z;
  return norm(body.position - position) + 2.0 * body.radius * std::sqrt(std::max(0.0, 1.0 - same * same));
}

}  // namespace

bool FreeFront::moves(BrickId brick) const {
  const int place = members_.place_of(brick);
  return place >= 0 && bricks_.member(place).moving;
}

// It joins the other front before the next step; until then what others read of this step stays as it is.
void FreeFront::lose(BrickId brick) {
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    if (bricks_.bodies[i].id != brick || bricks_.members[i].lost) continue;
    bricks_.members[i].lost = true;
    energy_law_.forget();
    if (bricks_.members[i].moving) --moving_;
    bricks_.members[i].moving = false;
  }
}

void FreeFront::disband() {
  for (const Body& body : bricks_.bodies) disown(body.id);
}

void FreeFront::set_moving(int place) {
  Body& body = bricks_.body(place);
  Member& member = bricks_.member(place);
  body.inverse_mass = 1.0 / world_.kinds[body.kind].mass;
  refresh(body);
  member.moving = true;
  member.quiet = member.stayed = 0.0;
  member.stays_at = body.position;
  member.stays_turned = body.orientation;
  member.tilt_cosine = (body.axes * member.local_up).z;
  member.middle = member.gain = {};
  impulses_.forget_plan();
  if (body.round) {  // It has no tilt: nothing arrives at it, and it does not fall.
    world_.arrived[static_cast<std::size_t>(body.id)] = 1;
    member.landed = true;
  }
  ++moving_;
  members_.list_floor(place);
}

void FreeFront::wake(BrickId brick, double /*time*/) {
  rouse(brick);
  if (world_.stacked) wake_structure(brick);
}

// Bricks of a structure carry and clamp each other: as obstacles that cannot move they would hold what is struck for ever. So all that
// stand and touch, one by the other, begin to move together.
void FreeFront::wake_structure(BrickId brick) {
  std::vector<BrickId>& roused = roused_;
  roused.assign(1, brick);
  for (std::size_t i = 0; i < roused.size(); ++i) {
    const int place = members_.place_of(roused[i]);
    const std::size_t known = roused.size();
    for (const Touch& touch : bricks_.touches) {
      if (touch.b == kFloor || !touch.bearing || (touch.a != place && touch.b != place)) continue;
      const auto other = static_cast<std::size_t>(touch.a == place ? touch.b : touch.a);
      const BrickId id = bricks_.bodies[other].id;
      if (bricks_.members[other].moving || bricks_.members[other].lost || bricks_.members[other].just_rested) continue;
      if (world_.phase[static_cast<std::size_t>(id)] != Phase::standing) continue;
      roused.push_back(id);
    }
    for (std::size_t k = known; k < roused.size(); ++k) {
      rouse(roused[k]);
    }
  }
}

void FreeFront::rouse(BrickId brick) {
  int place = members_.place_of(brick);
  if (place < 0) place = members_.add(brick);
  if (bricks_.member(place).moving) return;
  ledger_.woken.push_back(brick);
  set_moving(place);
  energy_law_.add(potential_energy(world_, brick, bricks_.body(place).position.z));
  members_.list_neighbours(place);
  members_.order_touches();
  members_.mark_borne_by(place);
}

void FreeFront::wake_unsupported(double now) {
  bool again = true;
  while (again) {
    again = false;
    for (const Touch& touch : bricks_.touches) {
      if (touch.b == kFloor || !touch.bearing) continue;
      const bool a_moves = bricks_.member(touch.a).moving;
      const bool b_moves = bricks_.member(touch.b).moving;
      if (a_moves == b_moves) continue;
      const auto mover = static_cast<std::size_t>(a_moves ? touch.a : touch.b);
      const auto still = static_cast<std::size_t>(a_moves ? touch.b : touch.a);
      const double moved = displacement(bricks_.bodies[mover], touch.mark_position, touch.mark_orientation);
      if (moved < world_.tolerances.support * bricks_.members[still].thin) continue;
      wake(bricks_.bodies[still].id, now);
      again = true;
      break;
    }
  }
}

void FreeFront::retire(double time) {
  if (world_.every_brick_moves) return;
  const Tolerances& limits = world_.tolerances;
  bool any = false;
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    Member& member = bricks_.members[i];
    Body& body = bricks_.bodies[i];
    member.just_rested = false;
    if (!member.moving) continue;
    // How far its farthest corner would go with this speed and this acceleration [m].
    const double horizon = limits.horizon * member.time_scale;
    const double speed = norm(body.velocity) + body.radius * norm(body.angular_velocity);
    const double gain = norm(body.velocity - member.velocity_before) + body.radius * norm(body.angular_velocity - member.spin_before);
    const double ahead = horizon * (speed + 0.5 * horizon * gain / world_.step);
    const bool quiet = ahead < limits.retire * member.thin && !member.pushed;
    member.quiet = quiet ? member.quiet + world_.step : 0.0;
    if (displacement(body, member.stays_at, member.stays_turned) > limits.retire * member.thin) {
      member.stays_at = body.position;
      member.stays_turned = body.orientation;
      member.stayed = 0.0;
    }
    member.stayed = member.pushed ? 0.0 : member.stayed + world_.step;
    if (member.quiet < limits.patience * member.time_scale && member.stayed < limits.stays * member.time_scale) continue;
    any = true;
    energy_law_.add(-kinetic_energy(body) - potential_energy(world_, body.id, body.position.z));
    member.moving = false;
    member.just_rested = true;
    --moving_;
    ledger_.moves.push_back({body.id, member.listed_at, body.position});
    ledger_.rested.push_back({body.id, {body.position, body.orientation}});
    note_rest(static_cast<int>(i), time);
    body.velocity = {};
    body.angular_velocity = {};
    member.middle = {};
    body.inverse_mass = 0.0;
    body.inverse_inertia = Mat3{};
    for (Touch& touch : bricks_.touches) {
      if (touch.b == kFloor || (touch.a != static_cast<int>(i) && touch.b != static_cast<int>(i))) continue;
      const Body& other = bricks_.body(touch.a == static_cast<int>(i) ? touch.b : touch.a);
      touch.bearing = touch.impulse > 0.0;
      touch.mark_position = other.position;
      touch.mark_orientation = other.orientation;
    }
  }
  rested_ = rested_ || any;
}

void FreeFront::adopt(std::span<const HandedBrick> bricks, std::span<const ActiveForce> forces) {
  for (const HandedBrick& handed : bricks) {
    // It joins where it is now, not where it last stood still.
    world_.pose[static_cast<std::size_t>(handed.brick)] = handed.pose;
    const int place = members_.add(handed.brick);
    set_moving(place);
    Body& body = bricks_.body(place);
    body.velocity = handed.velocity;
    body.angular_velocity = handed.angular_velocity;
    refresh(body);
    Member& member = bricks_.member(place);
    member.quiet = handed.quiet;
    member.pushed = handed.pushed;
    member.landed = handed.landed;
  }
  for (const HandedBrick& handed : bricks) members_.list_neighbours(members_.place_of(handed.brick));
  for (const HandedBrick& handed : bricks) members_.mark_borne_by(members_.place_of(handed.brick));
  bricks_.forces.insert(bricks_.forces.end(), forces.begin(), forces.end());
  impulses_.forget_plan();
  energy_law_.forget();
  members_.order_touches();
}

void FreeFront::absorb(FreeFront& other) {
  if (members_.drop_lost()) impulses_.forget_plan();
  for (std::size_t i = 0; i < other.bricks_.bodies.size(); ++i) {
    const auto id = static_cast<std::size_t>(other.bricks_.bodies[i].id);
    if (world_.front[id] != other.number()) continue;  // Lost to another one.
    world_.front[id] = number();
    world_.note_place(other.bricks_.bodies[i].id, static_cast<int>(bricks_.bodies.size()));
    bricks_.bodies.push_back(other.bricks_.bodies[i]);
    bricks_.members.push_back(other.bricks_.members[i]);
  }
  for (const Touch& theirs : other.bricks_.touches) {
    Touch touch = theirs;
    touch.a = members_.place_of(other.bricks_.body(theirs.a).id);
    if (theirs.b != kFloor) touch.b = members_.place_of(other.bricks_.body(theirs.b).id);
    if (touch.a < 0 || (theirs.b != kFloor && touch.b < 0)) continue;
    const bool listed =
        std::any_of(bricks_.touches.begin(), bricks_.touches.end(), [&](const Touch& t) { return t.a == touch.a && t.b == touch.b; });
    if (listed) continue;
    bricks_.touches.push_back(touch);
  }
  impulses_.forget_plan();
  energy_law_.join(other.energy_law_);
  moving_ += other.moving_;
  bricks_.forces.insert(bricks_.forces.end(), other.bricks_.forces.begin(), other.bricks_.forces.end());
  ledger_.events.insert(ledger_.events.end(), other.ledger_.events.begin(), other.ledger_.events.end());
  for (const std::int32_t number : other.ledger_.met) ledger_.meet(number);
  // What was of the other front has not been listed until now.
  const std::size_t count = bricks_.bodies.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!bricks_.members[i].moving) continue;
    world_.neighbours.moved(bricks_.bodies[i].id, bricks_.members[i].listed_at, bricks_.bodies[i].position);
    members_.list_neighbours(static_cast<int>(i));
  }
  members_.order_touches();
}

}  // namespace topple::rigid
