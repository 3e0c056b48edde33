#include "model/rigid/wavefront.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace topple::rigid {

namespace {

// How far beyond touching a brick lists others, as a share of its radius: it lists again before it has moved a third of that. Of a brick of
// another front only the place where that front listed it is known.
constexpr double kOwnSlack = 0.5;
constexpr double kForeignSlack = 0.6;

double thinnest(const Body& body) { return 2.0 * std::min({body.half.x, body.half.y, body.half.z}); }
double longest(const Body& body) { return 2.0 * std::max({body.half.x, body.half.y, body.half.z}); }

// How far the farthest corner may have moved [m].
double displacement(const Body& body, const Vec3& position, const Quat& orientation) {
  const Quat& q = body.orientation;
  const double same = q.w * orientation.w + q.x * orientation.x + q.y * orientation.y + q.z * orientation.z;
  return norm(body.position - position) + 2.0 * body.radius * std::sqrt(std::max(0.0, 1.0 - same * same));
}

}  // namespace

int Front::place_of(BrickId brick) const {
  if (!owns(brick)) return -1;
  const auto noted = static_cast<std::size_t>(world_.noted_place(brick));
  if (noted < bodies_.size() && bodies_[noted].id == brick) return static_cast<int>(noted);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (bodies_[i].id == brick) return static_cast<int>(i);
  }
  return -1;
}

bool Front::moves(BrickId brick) const {
  const int place = place_of(brick);
  return place >= 0 && members_[static_cast<std::size_t>(place)].moving;
}

// It joins the other front before the next step; until then what others read of this step stays as it is.
void Front::lose(BrickId brick) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (bodies_[i].id != brick || members_[i].lost) continue;
    members_[i].lost = true;
    energy_law_.forget();
    if (members_[i].moving) --moving_;
    members_[i].moving = false;
  }
}

void Front::drop_lost() {
  renamed_.assign(bodies_.size(), 0);
  bool any = false;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!members_[i].lost) continue;
    any = true;
    renamed_[i] = -1;
  }
  if (!any) return;
  planned_for_ = 0.0;
  std::erase_if(touches_, [this](const Touch& touch) {
    return members_[static_cast<std::size_t>(touch.a)].lost || (touch.b != kFloor && members_[static_cast<std::size_t>(touch.b)].lost);
  });
  keep_those(renamed_);
}

void Front::disband() {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    std::int32_t& owner = world_.front[static_cast<std::size_t>(bodies_[i].id)];
    if (owner == number_) owner = kNoFront;
  }
}

int Front::add(BrickId brick) {
  const auto at = static_cast<std::size_t>(brick);
  const int place = static_cast<int>(bodies_.size());
  const std::uint16_t kind = world_.given(brick).kind;
  Body body = make_body(world_.kinds[kind], brick, kind, world_.pose[at]);
  body.inverse_mass = 0.0;
  body.inverse_inertia = Mat3{};
  Member member;
  member.thin = thinnest(body);
  member.time_scale = std::sqrt(longest(body) / world_.gravity);
  const Quat put_down = world_.standing(brick).orientation;
  member.local_up = rotate(conjugate(put_down), Vec3{0.0, 0.0, 1.0});
  ledger_.take(brick);
  world_.note_place(brick, place);
  bodies_.push_back(body);
  members_.push_back(member);
  return place;
}

void Front::set_moving(int place) {
  Body& body = bodies_[static_cast<std::size_t>(place)];
  Member& member = members_[static_cast<std::size_t>(place)];
  body.inverse_mass = 1.0 / world_.kinds[body.kind].mass;
  refresh(body);
  member.moving = true;
  member.quiet = member.stayed = 0.0;
  member.stays_at = body.position;
  member.stays_turned = body.orientation;
  member.tilt_cosine = (body.axes * member.local_up).z;
  member.middle = member.gain = {};
  planned_for_ = 0.0;
  if (body.round) {  // It has no tilt: nothing arrives at it, and it does not fall.
    world_.arrived[static_cast<std::size_t>(body.id)] = 1;
    member.landed = true;
  }
  ++moving_;
  Touch floor;
  floor.a = place;
  const Surface& surface = world_.kinds[body.kind].surface;
  floor.friction = surface.floor_friction;
  floor.restitution = surface.floor_restitution;
  find_now(floor);  // A brick that has just begun to move stands on what it stood on.
  touches_.push_back(floor);
}

void Front::wake(BrickId brick, double /*time*/) {
  rouse(brick);
  if (world_.stacked) wake_structure(brick);
}

// Bricks of a structure carry and clamp each other: as obstacles that cannot move they would hold what is struck for ever. So all that
// stand and touch, one by the other, begin to move together.
void Front::wake_structure(BrickId brick) {
  std::vector<BrickId>& roused = roused_;
  roused.assign(1, brick);
  for (std::size_t i = 0; i < roused.size(); ++i) {
    const int place = place_of(roused[i]);
    const std::size_t known = roused.size();
    for (const Touch& touch : touches_) {
      if (touch.b == kFloor || !touch.bearing || (touch.a != place && touch.b != place)) continue;
      const auto other = static_cast<std::size_t>(touch.a == place ? touch.b : touch.a);
      const BrickId id = bodies_[other].id;
      if (members_[other].moving || members_[other].lost || members_[other].just_rested) continue;
      if (world_.phase[static_cast<std::size_t>(id)] != Phase::standing) continue;
      roused.push_back(id);
    }
    for (std::size_t k = known; k < roused.size(); ++k) {
      rouse(roused[k]);
    }
  }
}

void Front::rouse(BrickId brick) {
  int place = place_of(brick);
  if (place < 0) place = add(brick);
  if (members_[static_cast<std::size_t>(place)].moving) return;
  ledger_.woken.push_back(brick);
  set_moving(place);
  energy_law_.add(potential_energy(world_, brick, bodies_[static_cast<std::size_t>(place)].position.z));
  list_neighbours(place);
  order_touches();
  mark_borne_by(place);
}

// What stands on a brick that begins to move, or leans on it, wakes when it has gone.
void Front::mark_borne_by(int place) {
  const Body& body = bodies_[static_cast<std::size_t>(place)];
  for (Touch& touch : touches_) {
    if (touch.b == kFloor || (touch.a != place && touch.b != place)) continue;
    const int other = touch.a == place ? touch.b : touch.a;
    if (members_[static_cast<std::size_t>(other)].moving) continue;
    touch_boxes(bodies_[static_cast<std::size_t>(touch.a)], bodies_[static_cast<std::size_t>(touch.b)],
                world_.tolerances.touching * members_[static_cast<std::size_t>(place)].thin, touch.now);
    touch.bearing = touch.now.count > 0;
    touch.memory.fill(kTouching);
    touch.mark_position = body.position;
    touch.mark_orientation = body.orientation;
  }
}

void Front::list_neighbours(int place) {
  const Body body = bodies_[static_cast<std::size_t>(place)];
  members_[static_cast<std::size_t>(place)].listed_at = body.position;
  world_.neighbours.near(body.position, near_);
  for (const BrickId other : near_) {
    if (other == body.id) continue;
    int there = place_of(other);
    const auto at = static_cast<std::size_t>(other);
    const bool known = there >= 0;
    const Vec3 position = known ? bodies_[static_cast<std::size_t>(there)].position : world_.pose[at].position;
    const Vec3 size = half_extents(world_.kind_of(other));
    const bool foreign = !known && world_.front[at] != kNoFront && world_.front[at] != number_;
    const double reach = body.radius + norm(size) + (foreign ? kForeignSlack : kOwnSlack) * body.radius;
    const Vec3 apart = position - body.position;
    if (dot(apart, apart) > reach * reach) continue;
    if (foreign) {
      meet(world_.front[at]);
      continue;
    }
    if (!known) there = add(other);
    const int a = body.id < other ? place : there;
    const int b = body.id < other ? there : place;
    const bool listed = std::any_of(touches_.begin(), touches_.end(), [a, b](const Touch& t) { return t.a == a && t.b == b; });
    if (listed) continue;
    Touch touch;
    touch.a = a;
    touch.b = b;
    const SurfacePair surfaces = surface_pair(world_.layout, body.kind, world_.given(other).kind);
    touch.friction = surfaces.friction;
    touch.restitution = surfaces.restitution;
    find_now(touch);
    touches_.push_back(touch);
  }
}

void Front::list_those_that_strayed() {
  bool changed = false;
  const std::size_t count = bodies_.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!members_[i].moving) continue;
    const Vec3 strayed = bodies_[i].position - members_[i].listed_at;
    const double allowed = 0.15 * bodies_[i].radius;
    if (dot(strayed, strayed) < allowed * allowed) continue;
    ledger_.moves.push_back({bodies_[i].id, members_[i].listed_at, bodies_[i].position});
    list_neighbours(static_cast<int>(i));
    changed = true;
  }
  if (changed) {
    drop_idle();
    order_touches();
  }
}

void Front::drop_idle() {
  // Pairs of which neither moves, or that have gone out of reach.
  std::erase_if(touches_, [this](const Touch& touch) {
    if (touch.b == kFloor) return !members_[static_cast<std::size_t>(touch.a)].moving;
    const auto a = static_cast<std::size_t>(touch.a), b = static_cast<std::size_t>(touch.b);
    if (!members_[a].moving && !members_[b].moving) return true;
    const double reach = 2.0 * (bodies_[a].radius + bodies_[b].radius);
    const Vec3 apart = bodies_[a].position - bodies_[b].position;
    return dot(apart, apart) > reach * reach;
  });
  std::vector<int>& renamed = renamed_;
  renamed.assign(bodies_.size(), -1);
  for (const Touch& touch : touches_) {
    renamed[static_cast<std::size_t>(touch.a)] = 0;
    if (touch.b != kFloor) renamed[static_cast<std::size_t>(touch.b)] = 0;
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (renamed[i] < 0 && !members_[i].lost) ledger_.leave(bodies_[i].id);
  }
  keep_those(renamed);
  may_part_ = true;
}

// Leaves out the bodies marked by -1; no touch may name them.
void Front::keep_those(std::vector<int>& renamed) {
  int kept = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (renamed[i] < 0) continue;
    renamed[i] = kept;
    if (!members_[i].lost) world_.note_place(bodies_[i].id, kept);
    if (static_cast<std::size_t>(kept) != i) {
      bodies_[static_cast<std::size_t>(kept)] = bodies_[i];
      members_[static_cast<std::size_t>(kept)] = members_[i];
    }
    ++kept;
  }
  bodies_.resize(static_cast<std::size_t>(kept));
  members_.resize(static_cast<std::size_t>(kept));
  for (Touch& touch : touches_) {
    touch.a = renamed[static_cast<std::size_t>(touch.a)];
    if (touch.b != kFloor) touch.b = renamed[static_cast<std::size_t>(touch.b)];
  }
}

void Front::order_touches() {
  // By brick, its floor first: along a row the sweeps run with the wave and against it.
  const auto comes_before = [this](const Touch& l, const Touch& r) {
    const BrickId la = bodies_[static_cast<std::size_t>(l.a)].id, ra = bodies_[static_cast<std::size_t>(r.a)].id;
    if (la != ra) return la < ra;
    const BrickId lb = l.b == kFloor ? kNoBrick : bodies_[static_cast<std::size_t>(l.b)].id;
    const BrickId rb = r.b == kFloor ? kNoBrick : bodies_[static_cast<std::size_t>(r.b)].id;
    return lb < rb;
  };
  if (!std::is_sorted(touches_.begin(), touches_.end(), comes_before)) std::sort(touches_.begin(), touches_.end(), comes_before);
}

void Front::wake_unsupported(double now) {
  bool again = true;
  while (again) {
    again = false;
    for (const Touch& touch : touches_) {
      if (touch.b == kFloor || !touch.bearing) continue;
      const bool a_moves = members_[static_cast<std::size_t>(touch.a)].moving;
      const bool b_moves = members_[static_cast<std::size_t>(touch.b)].moving;
      if (a_moves == b_moves) continue;
      const auto mover = static_cast<std::size_t>(a_moves ? touch.a : touch.b);
      const auto still = static_cast<std::size_t>(a_moves ? touch.b : touch.a);
      const double moved = displacement(bodies_[mover], touch.mark_position, touch.mark_orientation);
      if (moved < world_.tolerances.support * members_[still].thin) continue;
      wake(bodies_[still].id, now);
      again = true;
      break;
    }
  }
}

void Front::retire(double time) {
  if (world_.every_brick_moves) return;
  const Tolerances& limits = world_.tolerances;
  bool any = false;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Member& member = members_[i];
    Body& body = bodies_[i];
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
    for (Touch& touch : touches_) {
      if (touch.b == kFloor || (touch.a != static_cast<int>(i) && touch.b != static_cast<int>(i))) continue;
      const Body& other = bodies_[static_cast<std::size_t>(touch.a == static_cast<int>(i) ? touch.b : touch.a)];
      touch.bearing = touch.impulse > 0.0;
      touch.mark_position = other.position;
      touch.mark_orientation = other.orientation;
    }
  }
  rested_ = rested_ || any;
}

void Front::adopt(std::span<const HandedBrick> bricks, std::span<const ActiveForce> forces) {
  for (const HandedBrick& handed : bricks) {
    // It joins where it is now, not where it last stood still.
    world_.pose[static_cast<std::size_t>(handed.brick)] = handed.pose;
    const int place = add(handed.brick);
    set_moving(place);
    Body& body = bodies_[static_cast<std::size_t>(place)];
    body.velocity = handed.velocity;
    body.angular_velocity = handed.angular_velocity;
    refresh(body);
    Member& member = members_[static_cast<std::size_t>(place)];
    member.quiet = handed.quiet;
    member.pushed = handed.pushed;
    member.landed = handed.landed;
  }
  for (const HandedBrick& handed : bricks) list_neighbours(place_of(handed.brick));
  for (const HandedBrick& handed : bricks) mark_borne_by(place_of(handed.brick));
  forces_.insert(forces_.end(), forces.begin(), forces.end());
  planned_for_ = 0.0;
  energy_law_.forget();
  order_touches();
}

void Front::absorb(Front& other) {
  drop_lost();
  for (std::size_t i = 0; i < other.bodies_.size(); ++i) {
    const auto id = static_cast<std::size_t>(other.bodies_[i].id);
    if (world_.front[id] != other.number_) continue;  // Lost to another one.
    world_.front[id] = number_;
    world_.note_place(other.bodies_[i].id, static_cast<int>(bodies_.size()));
    bodies_.push_back(other.bodies_[i]);
    members_.push_back(other.members_[i]);
  }
  for (const Touch& theirs : other.touches_) {
    Touch touch = theirs;
    touch.a = place_of(other.bodies_[static_cast<std::size_t>(theirs.a)].id);
    if (theirs.b != kFloor) touch.b = place_of(other.bodies_[static_cast<std::size_t>(theirs.b)].id);
    if (touch.a < 0 || (theirs.b != kFloor && touch.b < 0)) continue;
    const bool listed = std::any_of(touches_.begin(), touches_.end(), [&](const Touch& t) { return t.a == touch.a && t.b == touch.b; });
    if (listed) continue;
    touches_.push_back(touch);
  }
  planned_for_ = 0.0;
  energy_law_.join(other.energy_law_);
  moving_ += other.moving_;
  forces_.insert(forces_.end(), other.forces_.begin(), other.forces_.end());
  events_.insert(events_.end(), other.events_.begin(), other.events_.end());
  for (const std::int32_t number : other.met_) meet(number);
  // What was of the other front has not been listed until now.
  const std::size_t count = bodies_.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!members_[i].moving) continue;
    world_.neighbours.moved(bodies_[i].id, members_[i].listed_at, bodies_[i].position);
    list_neighbours(static_cast<int>(i));
  }
  order_touches();
}

}  // namespace topple::rigid
