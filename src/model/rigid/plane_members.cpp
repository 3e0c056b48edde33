#include "model/rigid/plane_members.h"

#include <algorithm>
#include <cmath>

#include "topple/profile.h"

namespace topple::rigid {

// Where a brick was put down, from the one beside it if that is known. Places are rounded; an even row is even here.
double PlaneMembers::stand_of(BrickId brick) {
  const double along = stand_along(plane_, world_, brick);
  for (const BrickId beside : {brick - 1, brick + 1}) {
    const int place = beside < world_.layout.brick_count() ? place_of(beside) : -1;
    if (place < 0) continue;
    const double apart = along - stand_along(plane_, world_, beside), pitch = std::abs(apart);
    if (std::abs(pitch - plane_.pitch) > kSamePitch) plane_.pitch = pitch;
    return state_.brick(place).stand + (apart > 0.0 ? plane_.pitch : -plane_.pitch);
  }
  return along - plane_.zero;
}

void PlaneMembers::count_from(int place) {
  const double shift = state_.brick(place).stand;
  plane_.zero = stand_along(plane_, world_, state_.brick(place).id);
  for (PlaneBrick& other : state_.bricks) {
    for (double* x : {&other.box.place.x, &other.next.place.x, &other.listed_at.x, &other.stand}) *x -= shift;
  }
  for (PlaneTouch& touch : state_.touches) {
    touch.mark.x -= shift;
    for (PlanePoint& point : touch.now.points) point.x -= shift;
  }
}

int PlaneMembers::place_of(BrickId brick) const {
  if (brick < 0 || !owns(world_, ledger_, brick)) return -1;
  const auto noted = static_cast<std::size_t>(world_.noted_place(brick));
  return noted < state_.bricks.size() && state_.bricks[noted].id == brick ? static_cast<int>(noted) : state_.place_of(brick);
}

int PlaneMembers::add(BrickId brick) {
  leave_plane_ = leave_plane_ || !put_down_in(plane_, world_, brick);
  return add(brick, locate_in(plane_, world_, brick, still(world_, ledger_, brick)).place);
}

int PlaneMembers::add(BrickId brick, const PlaneVec& moved) {
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
  const Still before = still(world_, ledger_, brick);
  added.aside = dot(before.pose.position - world_.foot(brick), plane_.across);
  // One that came to rest a little out of the plane stays so.
  if (before.rests) added.upright = in_plane(plane_, world_, brick, before.pose).upright;
  added.id = brick;
  added.kind = put.kind;
  plane_.half_width = std::max(plane_.half_width, 0.5 * size.across);
  const int index = static_cast<int>(state_.bricks.size());
  ledger_.take(brick);
  world_.note_place(brick, index);
  state_.bricks.push_back(added);
  return index;
}

PlaneTouch PlaneMembers::on_floor(int place, double within) const {
  const PlaneBrick& brick = state_.brick(place);
  const Surface& surface = world_.kinds[brick.kind].surface;
  PlaneTouch floor;
  floor.a = place;
  floor.thin = brick.thin;
  floor.friction = surface.floor_friction;
  floor.restitution = surface.floor_restitution;
  touch_floor(brick.box, within * brick.thin, floor.now);
  return floor;
}

void PlaneMembers::mark_borne_by(int place) {
  const PlaneBrick& woken = state_.brick(place);
  for (PlaneTouch& touch : state_.touches) {
    if (touch.b < 0 || (touch.a != place && touch.b != place)) continue;
    if (state_.brick(touch.a == place ? touch.b : touch.a).moving) continue;
    touch_boxes(state_.brick(touch.a).box, state_.brick(touch.b).box, world_.tolerances.touching * woken.thin, touch.now);
    touch.bearing = touch.now.count > 0;
    for (PlaneMemory& memory : touch.memory) memory = {.active = true};
    touch.mark = woken.box.place;
  }
  state_.find_near_pairs();
}

void PlaneMembers::list_neighbours(int place) {
  const Timed timed(world_.profile, Stage::plane_lists);
  const BrickId id = state_.brick(place).id;
  const double radius = 0.5 * norm(2.0 * half_extents(world_.kind_of(id)));
  const PlaneVec here = state_.brick(place).box.place;
  state_.brick(place).listed_at = here;
  const Vec3 centre = in_world(plane_, here.x, here.z);
  world_.neighbours.near(centre, near_);
  for (const BrickId other : near_) {
    if (other == id) continue;
    int there = place_of(other);
    if (there < 0) {
      there = add_if_near(other, centre, radius);
      if (there < 0) continue;
    } else {
      const PlaneVec apart = state_.brick(there).box.place - here;
      const double reach = 1.5 * radius + state_.brick(there).radius;
      if (apart.x * apart.x + apart.z * apart.z > reach * reach) continue;
    }
    const int a = id < other ? place : there, b = id < other ? there : place;
    if (std::any_of(state_.touches.begin(), state_.touches.end(), [a, b](const PlaneTouch& t) { return t.a == a && t.b == b; })) continue;
    list_pair(a, b);
  }
}

// A brick that does not belong to the front, if it is within reach of one of this radius at `centre` and nothing speaks against it: then
// its place, else -1.
int PlaneMembers::add_if_near(BrickId other, const Vec3& centre, double radius) {
  // One that this front has left in this step is nobody's.
  const std::int32_t owner = world_.front[static_cast<std::size_t>(other)], front = owner == ledger_.front ? kNoFront : owner;
  // Of a brick of another front only the place where that front listed it is known.
  const double reach = (front == kNoFront ? 1.5 : 1.6) * radius + norm(half_extents(world_.kind_of(other)));
  const Still found_at = still(world_, ledger_, other);
  const Vec3 apart = found_at.pose.position - centre;
  if (dot(apart, apart) > reach * reach) return -1;
  const InPlane found = locate_in(plane_, world_, other, found_at);
  if (found.misses) return -1;
  if (front == kNoFront && found.lies) return add(other, found.place);
  if (front != kNoFront) {
    ledger_.meet(front);
  } else {
    leave_plane_ = true;
  }
  return -1;
}

void PlaneMembers::list_pair(int a, int b) {
  PlaneTouch& touch = state_.touches.emplace_back();
  touch.a = a;
  touch.b = b;
  touch.thin = std::min(state_.brick(a).thin, state_.brick(b).thin);
  const SurfacePair surfaces = surface_pair(world_.layout, state_.brick(a).kind, state_.brick(b).kind);
  touch.friction = surfaces.friction;
  touch.restitution = surfaces.restitution;
  touch_boxes(state_.brick(a).box, state_.brick(b).box, world_.tolerances.margin * touch.thin, touch.now);
  for (int k = 0; k < touch.now.count; ++k) {
    const auto at = static_cast<std::size_t>(k);
    touch.memory[at].active = touch.now.points[at].separation < world_.tolerances.touching * touch.thin;
  }
}

void PlaneMembers::drop_idle() {
  std::erase_if(state_.touches, [this](const PlaneTouch& touch) {
    const PlaneBrick& a = state_.brick(touch.a);
    if (touch.b < 0) return !a.moving;
    const PlaneBrick& b = state_.brick(touch.b);
    if (!a.moving && !b.moving) return true;
    // Farther than where they are listed, by less than bricks go before their lists are made anew.
    const double reach = 1.4 * (a.radius + b.radius);
    const PlaneVec apart = a.box.place - b.box.place;
    return apart.x * apart.x + apart.z * apart.z > reach * reach;
  });
  for (PlaneBrick& brick : state_.bricks) brick.unknown = brick.moving ? 0 : -1;
  for (const PlaneTouch& touch : state_.touches) {
    state_.brick(touch.a).unknown = 0;
    if (touch.b >= 0) state_.brick(touch.b).unknown = 0;
  }
  for (const PlaneBrick& brick : state_.bricks) {
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

bool PlaneMembers::in_order() const {
  for (std::size_t i = 0; i < state_.bricks.size(); ++i) {
    if (!owns(world_, ledger_, state_.bricks[i].id) || (i > 0 && comes_before(state_.bricks[i], state_.bricks[i - 1]))) return false;
  }
  return true;
}

void PlaneMembers::order() {
  if (!in_order()) order_bricks();
  for (std::size_t i = 1; i < state_.touches.size(); ++i) {
    if (!comes_before(state_.touches[i], state_.touches[i - 1])) continue;
    std::size_t at = i - 1;
    while (at > 0 && comes_before(state_.touches[i], state_.touches[at - 1])) --at;
    const auto begin = state_.touches.begin();
    std::rotate(begin + static_cast<std::ptrdiff_t>(at), begin + static_cast<std::ptrdiff_t>(i),
                begin + static_cast<std::ptrdiff_t>(i) + 1);
  }
  state_.find_near_pairs();
}

void PlaneMembers::order_bricks() {
  renamed_.resize(state_.bricks.size());
  std::vector<PlaneBrick>& kept = spare_;
  std::vector<int>& by_place = by_place_;
  kept.clear();
  by_place.clear();
  for (std::size_t i = 0; i < state_.bricks.size(); ++i) {
    if (owns(world_, ledger_, state_.bricks[i].id)) by_place.push_back(static_cast<int>(i));
  }
  std::sort(by_place.begin(), by_place.end(), [this](int l, int r) { return comes_before(state_.brick(l), state_.brick(r)); });
  for (const int from : by_place) {
    renamed_[static_cast<std::size_t>(from)] = static_cast<int>(kept.size());
    kept.push_back(state_.brick(from));
    world_.note_place(kept.back().id, static_cast<int>(kept.size()) - 1);
  }
  state_.bricks.swap(kept);
  for (PlaneTouch& touch : state_.touches) {
    touch.a = renamed_[static_cast<std::size_t>(touch.a)];
    if (touch.b >= 0) touch.b = renamed_[static_cast<std::size_t>(touch.b)];
  }
}

}  // namespace topple::rigid
