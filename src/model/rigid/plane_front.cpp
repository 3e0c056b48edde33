// Which bricks a plane front is made of: lists of neighbours, waking, resting.
#include "model/rigid/plane_front.h"

#include <algorithm>
#include <cmath>

#include "base/trigonometry.h"

namespace topple::rigid {

namespace {

// A brick is borne by another one where the normal of their contact points up by more than this.
constexpr double kLeans = 0.1;

// What rests goes on to lean on what moves, so it may rest after this share of the time that others have to wait.
constexpr double kPatience = 0.5;
constexpr double kRetire = 1.25;

// How far the farthest corner has moved [m].
double displacement(const PlaneBrick& brick, const PlaneVec& from) {
  const PlaneVec moved = brick.box.place - from;
  return std::sqrt(moved.x * moved.x + moved.z * moved.z) + brick.radius * std::abs(moved.turn);
}

}  // namespace

PlaneFront::PlaneFront(World& world, std::int32_t number, BrickId first) : Wave(world, number), plane_(plane_of_row(world, first)) {}

// Where a brick was put down, from the one beside it if that is known. Places are rounded; an even row is even here.
double PlaneFront::stand_of(BrickId brick) {
  const double along = stand_along(plane_, world_, brick);
  for (const BrickId beside : {brick - 1, brick + 1}) {
    const int place = beside < world_.layout.brick_count() ? place_of(beside) : -1;
    if (place < 0) continue;
    const double apart = along - stand_along(plane_, world_, beside), pitch = std::abs(apart);
    if (std::abs(pitch - pitch_) > kSamePitch) pitch_ = pitch;
    return bricks_[static_cast<std::size_t>(place)].stand + (apart > 0.0 ? pitch_ : -pitch_);
  }
  return along - origin_;
}

// From here on places along the row are against where this brick was put down.
void PlaneFront::count_from(const PlaneBrick& brick) {
  const double shift = brick.stand;
  origin_ = stand_along(plane_, world_, brick.id);
  for (PlaneBrick& other : bricks_) {
    for (double* x : {&other.box.place.x, &other.next.place.x, &other.listed_at.x, &other.stand}) *x -= shift;
  }
  for (PlaneTouch& touch : touches_) {
    touch.mark.x -= shift;
    for (PlanePoint& point : touch.now.points) point.x -= shift;
  }
}

int PlaneFront::place_of(BrickId brick) const {
  if (brick < 0 || !owns(brick)) return -1;
  const auto noted = static_cast<std::size_t>(world_.noted_place(brick));
  if (noted < bricks_.size() && bricks_[noted].id == brick) return static_cast<int>(noted);
  for (std::size_t i = 0; i < bricks_.size(); ++i) {
    if (bricks_[i].id == brick) return static_cast<int>(i);
  }
  return -1;
}

Vec3 PlaneFront::in_world(double x, double z) const {
  const double along = origin_ + x;
  return {plane_.origin.x + along * plane_.along.x, plane_.origin.y + along * plane_.along.y, z};
}

// Of half the turn; by roots, which are exact everywhere, while it is less than a right angle and a half.
SinCos PlaneFront::half_turn(const PlaneBox& box) {
  if (box.cosine < -0.7 || std::abs(box.place.turn) > 3.0) return sin_cos(0.5 * box.place.turn);
  const double cosine = std::sqrt(0.5 + 0.5 * box.cosine);
  return {.sin = 0.5 * box.sine / cosine, .cos = cosine};
}

Pose PlaneFront::pose_of(const PlaneBrick& brick) const {
  const SinCos half = half_turn(brick.box);
  const Quat turn{half.cos, half.sin * plane_.across.x, half.sin * plane_.across.y, 0.0};
  const Vec3 foot = world_.foot(brick.id);
  const double moved = brick.box.place.x - brick.stand;
  const Vec3 place = {foot.x + (moved * plane_.along.x + brick.aside * plane_.across.x),
                      foot.y + (moved * plane_.along.y + brick.aside * plane_.across.y), brick.box.place.z};
  return {place, turn * brick.upright};
}

// What came to rest in this step is not entered in the world yet.
const Pose& PlaneFront::last_pose(BrickId brick) const {
  for (const Ledger::Rest& rest : ledger_.rested) {
    if (rest.brick == brick) return rest.pose;
  }
  return world_.pose[static_cast<std::size_t>(brick)];
}

bool PlaneFront::rests(BrickId brick) const {
  return world_.phase[static_cast<std::size_t>(brick)] == Phase::resting ||
         std::any_of(ledger_.rested.begin(), ledger_.rested.end(), [brick](const Ledger::Rest& rest) { return rest.brick == brick; });
}

InPlane PlaneFront::locate(BrickId brick) const { return locate_in(plane_, world_, brick, last_pose(brick), rests(brick), half_width_); }

int PlaneFront::add(BrickId brick, const PlaneVec& moved) {
  const Brick& put = world_.given(brick);
  const BrickKind& kind = world_.kinds[put.kind];
  const Extents size = extents(kind, put.stance);
  PlaneBrick added;
  added.stand = stand_of(brick);
  added.box.place = moved;
  added.box.place.x += added.stand;
  added.box.half_along = 0.5 * size.along;
  added.box.half_up = 0.5 * size.up;
  set_turn(added.box);
  added.next = added.box;
  added.mass = kind.mass;
  added.inertia = kind.mass * (size.along * size.along + size.up * size.up) / 12.0;
  added.inverse_mass = 1.0 / added.mass;
  added.inverse_inertia = 1.0 / added.inertia;
  added.radius = 0.5 * std::sqrt(size.along * size.along + size.up * size.up);
  added.thin = std::min({kind.height, kind.width, kind.thickness});
  added.time_scale = std::sqrt(std::max({kind.height, kind.width, kind.thickness}) / world_.gravity);
  added.upright = world_.standing(brick).orientation;
  const Pose& pose = last_pose(brick);
  added.aside = dot(pose.position - world_.foot(brick), plane_.across);
  // One that came to rest a little out of the plane stays so.
  if (rests(brick)) added.upright = in_plane(plane_, world_, brick, pose).upright;
  added.id = brick;
  added.kind = put.kind;
  half_width_ = std::max(half_width_, 0.5 * size.across);
  const int index = static_cast<int>(bricks_.size());
  ledger_.take(brick);
  world_.note_place(brick, index);
  bricks_.push_back(added);
  return index;
}

void PlaneFront::wake(BrickId brick, double /*time*/) {
  interrupt();
  int place = place_of(brick);
  if (place < 0) {
    leaves_plane_ = leaves_plane_ || !put_down_in(plane_, world_, brick);
    place = add(brick, locate(brick).place);
  }
  if (bricks_[static_cast<std::size_t>(place)].moving) return;
  // One that came to rest in this very step has not rested for anybody else.
  if (std::erase_if(ledger_.rested, [brick](const Ledger::Rest& rest) { return rest.brick == brick; }) == 0) ledger_.woken.push_back(brick);
  std::erase_if(rested_now_, [brick](const PlaneBrick& rested) { return rested.id == brick; });
  PlaneBrick& woken = bricks_[static_cast<std::size_t>(place)];
  woken.moving = true;
  energy_law_.add(potential_energy(world_, brick, woken.box.place.z));
  woken.quiet = 0.0;
  woken.before_drift = {};
  woken.listed_at = woken.box.place;
  ++moving_;
  planned_for_ = 0.0;
  // It presses by itself again.
  for (PlaneTouch& touch : touches_) {
    if (touch.a != place && touch.b != place) continue;
    for (PlaneMemory& memory : touch.memory) {
      if (memory.leaning > 0.0) memory.kick = {};
      memory.leaning = memory.leaning_tangent = 0.0;
    }
  }
  PlaneTouch floor = on_floor(place, world_.tolerances.touching);
  // A brick that has just begun to move stands on what it stood on.
  for (PlaneMemory& memory : floor.memory) memory.active = true;
  touches_.push_back(floor);
  list_neighbours(place);
  order();
  mark_borne_by(place_of(brick));
}

// How a brick stands on the floor, with the points within so many thicknesses of it.
PlaneTouch PlaneFront::on_floor(int place, double within) const {
  const PlaneBrick& brick = bricks_[static_cast<std::size_t>(place)];
  const Surface& surface = world_.kinds[brick.kind].surface;
  PlaneTouch floor;
  floor.a = place;
  floor.thin = brick.thin;
  floor.friction = surface.floor_friction;
  floor.restitution = surface.floor_restitution;
  touch_floor(brick.box, within * brick.thin, floor.now);
  return floor;
}

// What stands on a brick that begins to move, or leans on it, wakes when it has gone.
void PlaneFront::mark_borne_by(int place) {
  const PlaneBrick& woken = bricks_[static_cast<std::size_t>(place)];
  for (PlaneTouch& touch : touches_) {
    if (touch.b < 0 || (touch.a != place && touch.b != place)) continue;
    if (bricks_[static_cast<std::size_t>(touch.a == place ? touch.b : touch.a)].moving) continue;
    touch_boxes(bricks_[static_cast<std::size_t>(touch.a)].box, bricks_[static_cast<std::size_t>(touch.b)].box,
                world_.tolerances.touching * woken.thin, touch.now);
    touch.bearing = touch.now.count > 0;
    for (PlaneMemory& memory : touch.memory) memory = {.active = true};
    touch.mark = woken.box.place;
  }
  find_near_pairs();
}

void PlaneFront::list_neighbours(int place) {
  const Timed timed(world_.profile, Stage::plane_lists);
  const BrickId id = bricks_[static_cast<std::size_t>(place)].id;
  const double radius = 0.5 * norm(2.0 * half_extents(world_.kind_of(id)));
  bricks_[static_cast<std::size_t>(place)].listed_at = bricks_[static_cast<std::size_t>(place)].box.place;
  const PlaneVec here = bricks_[static_cast<std::size_t>(place)].box.place;
  const Vec3 centre = in_world(here.x, here.z);
  world_.neighbours.near(centre, near_);
  for (const BrickId other : near_) {
    if (other == id) continue;
    int there = place_of(other);
    if (there < 0) {
      // One that this front has left in this step is nobody's.
      const std::int32_t owner = world_.front[static_cast<std::size_t>(other)], front = owner == number_ ? kNoFront : owner;
      // Of a brick of another front only the place where that front listed it is known.
      const double reach = (front == kNoFront ? 1.5 : 1.6) * radius + norm(half_extents(world_.kind_of(other)));
      const Vec3 apart = last_pose(other).position - centre;
      if (dot(apart, apart) > reach * reach) continue;
      const InPlane found = locate(other);
      if (found.misses) continue;
      if (front != kNoFront) {
        meet(front);
        continue;
      }
      if (!found.lies) {
        leaves_plane_ = true;
        continue;
      }
      there = add(other, found.place);
    } else {
      const PlaneVec apart = bricks_[static_cast<std::size_t>(there)].box.place - here;
      const double reach = 1.5 * radius + bricks_[static_cast<std::size_t>(there)].radius;
      if (apart.x * apart.x + apart.z * apart.z > reach * reach) continue;
    }
    const int a = id < other ? place : there, b = id < other ? there : place;
    if (std::any_of(touches_.begin(), touches_.end(), [a, b](const PlaneTouch& t) { return t.a == a && t.b == b; })) continue;
    PlaneTouch touch;
    touch.a = a;
    touch.b = b;
    touch.thin = std::min(bricks_[static_cast<std::size_t>(a)].thin, bricks_[static_cast<std::size_t>(b)].thin);
    const SurfacePair surfaces =
        surface_pair(world_.layout, bricks_[static_cast<std::size_t>(place)].kind, bricks_[static_cast<std::size_t>(there)].kind);
    touch.friction = surfaces.friction;
    touch.restitution = surfaces.restitution;
    touches_.push_back(touch);
    PlaneTouch& listed = touches_.back();
    touch_boxes(bricks_[static_cast<std::size_t>(a)].box, bricks_[static_cast<std::size_t>(b)].box, world_.tolerances.margin * listed.thin,
                listed.now);
    for (int k = 0; k < listed.now.count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      listed.memory[at].active = listed.now.points[at].separation < world_.tolerances.touching * listed.thin;
    }
  }
}

// From where a brick was listed to where it is.
void PlaneFront::move(BrickId brick, const PlaneVec& from, const PlaneVec& to) {
  ledger_.moves.push_back({brick, in_world(from.x, from.z), in_world(to.x, to.z)});
  if (even_ > 0) cycle_.drifts[cycle_.count - 1].moves.push_back({brick - cycle_.first, from, to});
}

void PlaneFront::list_those_that_strayed() {
  const std::size_t count = bricks_.size(), pairs = touches_.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!bricks_[i].moving) continue;
    const PlaneVec strayed = bricks_[i].box.place - bricks_[i].listed_at;
    // Two that come towards each other are listed in time: half a radius is to spare.
    const double allowed = 0.24 * bricks_[i].radius;
    if (strayed.x * strayed.x + strayed.z * strayed.z < allowed * allowed) continue;
    move(bricks_[i].id, bricks_[i].listed_at, bricks_[i].box.place);
    list_neighbours(static_cast<int>(i));
  }
  if (touches_.size() != pairs || rested_) {
    drop_idle();
    order();
  }
  rested_ = false;
}

// Leaves out pairs of which neither moves, or that have gone out of reach, and then bricks that are in no pair.
void PlaneFront::drop_idle() {
  std::erase_if(touches_, [this](const PlaneTouch& touch) {
    const PlaneBrick& a = bricks_[static_cast<std::size_t>(touch.a)];
    if (touch.b < 0) return !a.moving;
    const PlaneBrick& b = bricks_[static_cast<std::size_t>(touch.b)];
    if (!a.moving && !b.moving) return true;
    // Farther than where they are listed, by less than bricks go before their lists are made anew.
    const double reach = 1.4 * (a.radius + b.radius);
    const PlaneVec apart = a.box.place - b.box.place;
    return apart.x * apart.x + apart.z * apart.z > reach * reach;
  });
  for (PlaneBrick& brick : bricks_) brick.unknown = brick.moving ? 0 : -1;
  for (const PlaneTouch& touch : touches_) {
    bricks_[static_cast<std::size_t>(touch.a)].unknown = 0;
    if (touch.b >= 0) bricks_[static_cast<std::size_t>(touch.b)].unknown = 0;
  }
  for (const PlaneBrick& brick : bricks_) {
    if (brick.unknown < 0) ledger_.leave(brick.id);
  }
}

namespace {

bool comes_before(const PlaneBrick& left, const PlaneBrick& right) {
  return left.box.place.x != right.box.place.x ? left.box.place.x < right.box.place.x : left.id < right.id;
}

// By the later brick of each: those that are new then come last, and little has to move.
bool comes_before(const PlaneTouch& l, const PlaneTouch& r) {
  const int left = std::max(l.a, l.b), right = std::max(r.a, r.b);
  return left != right ? left < right : std::min(l.a, l.b) < std::min(r.a, r.b);
}

}  // namespace

bool PlaneFront::in_order() const {
  for (std::size_t i = 0; i < bricks_.size(); ++i) {
    if (!owns(bricks_[i].id) || (i > 0 && comes_before(bricks_[i], bricks_[i - 1]))) return false;
  }
  return true;
}

// Bricks along the row, so that the system of equations is a chain; touches by brick, its floor first.
void PlaneFront::order() {
  if (!in_order()) order_bricks();
  for (std::size_t i = 1; i < touches_.size(); ++i) {
    if (!comes_before(touches_[i], touches_[i - 1])) continue;
    std::size_t at = i - 1;
    while (at > 0 && comes_before(touches_[i], touches_[at - 1])) --at;
    const auto begin = touches_.begin();
    std::rotate(begin + static_cast<std::ptrdiff_t>(at), begin + static_cast<std::ptrdiff_t>(i),
                begin + static_cast<std::ptrdiff_t>(i) + 1);
  }
  find_near_pairs();
}

void PlaneFront::order_bricks() {
  renamed_.resize(bricks_.size());
  std::vector<PlaneBrick>& kept = spare_;
  std::vector<int>& by_place = by_place_;
  kept.clear();
  by_place.clear();
  for (std::size_t i = 0; i < bricks_.size(); ++i) {
    if (owns(bricks_[i].id)) by_place.push_back(static_cast<int>(i));
  }
  std::sort(by_place.begin(), by_place.end(),
            [this](int l, int r) { return comes_before(bricks_[static_cast<std::size_t>(l)], bricks_[static_cast<std::size_t>(r)]); });
  for (const int from : by_place) {
    renamed_[static_cast<std::size_t>(from)] = static_cast<int>(kept.size());
    kept.push_back(bricks_[static_cast<std::size_t>(from)]);
    world_.note_place(kept.back().id, static_cast<int>(kept.size()) - 1);
  }
  bricks_.swap(kept);
  for (PlaneTouch& touch : touches_) {
    touch.a = renamed_[static_cast<std::size_t>(touch.a)];
    if (touch.b >= 0) touch.b = renamed_[static_cast<std::size_t>(touch.b)];
  }
}

void PlaneFront::wake_unsupported(double now) {
  // What leans goes on to press, and that force does work: little beside that of a wave, too much for a brick or two.
  const double support = (moving_ <= kFew ? 0.1 : 1.0) * world_.tolerances.support;
  for (bool again = true; again;) {
    again = false;
    for (const PlaneTouch& touch : touches_) {
      if (touch.b < 0 || !touch.bearing) continue;
      const PlaneBrick& a = bricks_[static_cast<std::size_t>(touch.a)];
      const PlaneBrick& b = bricks_[static_cast<std::size_t>(touch.b)];
      if (a.moving == b.moving) continue;
      const PlaneBrick& still = a.moving ? b : a;
      if (displacement(a.moving ? a : b, touch.mark) < support * still.thin) continue;
      wake(still.id, now);
      again = true;
      break;
    }
  }
}

// A brick that has come to rest goes on to press on those that bear it, as long as they move: if its weight went at once, the states of all
// contacts of the wave would change.
void PlaneFront::let_lean(PlaneTouch& touch, bool a_rests) const {
  const PlaneBrick& other = bricks_[static_cast<std::size_t>(a_rests ? touch.b : touch.a)];
  const bool is_borne = (a_rests ? 1.0 : -1.0) * touch.now.normal_z > kLeans;
  for (PlaneMemory& memory : touch.memory) {
    memory.leaning = other.moving && is_borne ? memory.normal : 0.0;
    memory.leaning_tangent = other.moving && is_borne ? memory.tangent : 0.0;
    if (memory.leaning > 0.0) memory.kick = {.pressed = false};
  }
}

void PlaneFront::retire(double time) {
  const Timed timed(world_.profile, Stage::plane_rest);
  const Tolerances& limits = world_.tolerances;
  for (std::size_t i = 0; i < bricks_.size(); ++i) {
    PlaneBrick& brick = bricks_[i];
    if (!brick.moving) continue;
    // How far its farthest corner would go with this speed and this acceleration [m].
    const double horizon = limits.horizon * brick.time_scale;
    const auto corner = [&brick](const PlaneVec& v) { return std::sqrt(v.x * v.x + v.z * v.z) + brick.radius * std::abs(v.turn); };
    const double gain = corner(brick.velocity - brick.velocity_before) / since_look_;
    const double ahead = horizon * (corner(brick.velocity) + 0.5 * horizon * gain);
    brick.quiet = ahead < kRetire * limits.retire * brick.thin && !brick.pushed ? brick.quiet + since_look_ : 0.0;
    if (brick.quiet < kPatience * limits.patience * brick.time_scale) continue;
    energy_law_.add(-kinetic_energy(brick, brick.velocity) - potential_energy(world_, brick.id, brick.box.place.z));
    rested_ = true;
    brick.moving = false;
    --moving_;
    move(brick.id, brick.listed_at, brick.box.place);
    ledger_.rested.push_back({brick.id, pose_of(brick)});
    note_rest(static_cast<int>(i), time);
    brick.velocity = {};
    brick.middle = {};
    rested_now_.push_back(brick);
    for (PlaneTouch& touch : touches_) {
      if (touch.b < 0 || (touch.a != static_cast<int>(i) && touch.b != static_cast<int>(i))) continue;
      touch.bearing = touch.impulse > 0.0;
      let_lean(touch, touch.a == static_cast<int>(i));
      touch.mark = bricks_[static_cast<std::size_t>(touch.a == static_cast<int>(i) ? touch.b : touch.a)].box.place;
    }
  }
}

bool PlaneFront::moves(BrickId brick) const {
  const int place = place_of(brick);
  return place >= 0 && bricks_[static_cast<std::size_t>(place)].moving;
}

}  // namespace topple::rigid
