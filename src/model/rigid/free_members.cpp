#include "model/rigid/free_members.h"

#include <algorithm>
#include <cmath>

namespace topple::rigid {

namespace {

// How far beyond touching a brick lists others, as a share of its radius: it lists again before it has moved a third of that. Of a brick of
// another front only the place where that front listed it is known.
constexpr double kOwnSlack = 0.5;
constexpr double kForeignSlack = 0.6;

double thinnest(const Body& body) { return 2.0 * std::min({body.half.x, body.half.y, body.half.z}); }
double longest(const Body& body) { return 2.0 * std::max({body.half.x, body.half.y, body.half.z}); }

}  // namespace

int FreeMembers::place_of(BrickId brick) const {
  if (!owns(world_, ledger_, brick)) return -1;
  const auto noted = static_cast<std::size_t>(world_.noted_place(brick));
  return noted < bricks_.bodies.size() && bricks_.bodies[noted].id == brick ? static_cast<int>(noted) : bricks_.place_of(brick);
}

int FreeMembers::add(BrickId brick) {
  const auto at = static_cast<std::size_t>(brick);
  const int place = static_cast<int>(bricks_.bodies.size());
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
  bricks_.bodies.push_back(body);
  bricks_.members.push_back(member);
  return place;
}

void FreeMembers::list_floor(int place) {
  Touch floor;
  floor.a = place;
  const Surface& surface = world_.kinds[bricks_.body(place).kind].surface;
  floor.friction = surface.floor_friction;
  floor.restitution = surface.floor_restitution;
  find_now(floor);
  bricks_.touches.push_back(floor);
}

void FreeMembers::list_neighbours(int place) {
  const Body body = bricks_.body(place);
  bricks_.member(place).listed_at = body.position;
  world_.neighbours.near(body.position, near_);
  for (const BrickId other : near_) {
    if (other == body.id) continue;
    int there = place_of(other);
    const auto at = static_cast<std::size_t>(other);
    const bool known = there >= 0;
    const Vec3 position = known ? bricks_.body(there).position : world_.pose[at].position;
    const Vec3 size = half_extents(world_.kind_of(other));
    const bool foreign = !known && world_.front[at] != kNoFront && world_.front[at] != ledger_.front;
    const double reach = body.radius + norm(size) + (foreign ? kForeignSlack : kOwnSlack) * body.radius;
    const Vec3 apart = position - body.position;
    if (dot(apart, apart) > reach * reach) continue;
    if (foreign) {
      ledger_.meet(world_.front[at]);
      continue;
    }
    if (!known) there = add(other);
    const int a = body.id < other ? place : there;
    const int b = body.id < other ? there : place;
    const bool listed =
        std::any_of(bricks_.touches.begin(), bricks_.touches.end(), [a, b](const Touch& t) { return t.a == a && t.b == b; });
    if (listed) continue;
    Touch touch;
    touch.a = a;
    touch.b = b;
    const SurfacePair surfaces = surface_pair(world_.layout, body.kind, world_.given(other).kind);
    touch.friction = surfaces.friction;
    touch.restitution = surfaces.restitution;
    find_now(touch);
    bricks_.touches.push_back(touch);
  }
}

bool FreeMembers::list_those_that_strayed() {
  bool changed = false;
  const std::size_t count = bricks_.bodies.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!bricks_.members[i].moving) continue;
    const Vec3 strayed = bricks_.bodies[i].position - bricks_.members[i].listed_at;
    const double allowed = 0.15 * bricks_.bodies[i].radius;
    if (dot(strayed, strayed) < allowed * allowed) continue;
    ledger_.moves.push_back({bricks_.bodies[i].id, bricks_.members[i].listed_at, bricks_.bodies[i].position});
    list_neighbours(static_cast<int>(i));
    changed = true;
  }
  if (changed) {
    drop_idle();
    order_touches();
  }
  return changed;
}

void FreeMembers::mark_borne_by(int place) {
  const Body& body = bricks_.body(place);
  for (Touch& touch : bricks_.touches) {
    if (touch.b == kFloor || (touch.a != place && touch.b != place)) continue;
    const int other = touch.a == place ? touch.b : touch.a;
    if (bricks_.member(other).moving) continue;
    touch_boxes(bricks_.body(touch.a), bricks_.body(touch.b), world_.tolerances.touching * bricks_.member(place).thin, touch.now);
    touch.bearing = touch.now.count > 0;
    touch.memory.fill(kTouching);
    touch.mark_position = body.position;
    touch.mark_orientation = body.orientation;
  }
}

void FreeMembers::drop_idle() {
  std::erase_if(bricks_.touches, [this](const Touch& touch) {
    if (touch.b == kFloor) return !bricks_.member(touch.a).moving;
    const auto a = static_cast<std::size_t>(touch.a), b = static_cast<std::size_t>(touch.b);
    if (!bricks_.members[a].moving && !bricks_.members[b].moving) return true;
    const double reach = 2.0 * (bricks_.bodies[a].radius + bricks_.bodies[b].radius);
    const Vec3 apart = bricks_.bodies[a].position - bricks_.bodies[b].position;
    return dot(apart, apart) > reach * reach;
  });
  renamed_.assign(bricks_.bodies.size(), -1);
  for (const Touch& touch : bricks_.touches) {
    renamed_[static_cast<std::size_t>(touch.a)] = 0;
    if (touch.b != kFloor) renamed_[static_cast<std::size_t>(touch.b)] = 0;
  }
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    if (renamed_[i] < 0 && !bricks_.members[i].lost) ledger_.leave(bricks_.bodies[i].id);
  }
  keep_those(renamed_);
}

bool FreeMembers::drop_lost() {
  renamed_.assign(bricks_.bodies.size(), 0);
  bool any = false;
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    if (!bricks_.members[i].lost) continue;
    any = true;
    renamed_[i] = -1;
  }
  if (!any) return false;
  std::erase_if(bricks_.touches,
                [this](const Touch& touch) { return bricks_.member(touch.a).lost || (touch.b != kFloor && bricks_.member(touch.b).lost); });
  keep_those(renamed_);
  return true;
}

void FreeMembers::keep_those(std::vector<int>& renamed) {
  int kept = 0;
  for (std::size_t i = 0; i < bricks_.bodies.size(); ++i) {
    if (renamed[i] < 0) continue;
    renamed[i] = kept;
    if (!bricks_.members[i].lost) world_.note_place(bricks_.bodies[i].id, kept);
    if (static_cast<std::size_t>(kept) != i) {
      bricks_.body(kept) = bricks_.bodies[i];
      bricks_.member(kept) = bricks_.members[i];
    }
    ++kept;
  }
  bricks_.bodies.resize(static_cast<std::size_t>(kept));
  bricks_.members.resize(static_cast<std::size_t>(kept));
  for (Touch& touch : bricks_.touches) {
    touch.a = renamed[static_cast<std::size_t>(touch.a)];
    if (touch.b != kFloor) touch.b = renamed[static_cast<std::size_t>(touch.b)];
  }
}

void FreeMembers::order_touches() {
  const auto comes_before = [this](const Touch& l, const Touch& r) {
    const BrickId la = bricks_.body(l.a).id, ra = bricks_.body(r.a).id;
    if (la != ra) return la < ra;
    const BrickId lb = l.b == kFloor ? kNoBrick : bricks_.body(l.b).id;
    const BrickId rb = r.b == kFloor ? kNoBrick : bricks_.body(r.b).id;
    return lb < rb;
  };
  if (!std::is_sorted(bricks_.touches.begin(), bricks_.touches.end(), comes_before))
    std::sort(bricks_.touches.begin(), bricks_.touches.end(), comes_before);
}

// Of a pair that was not looked at before: what touches at this moment has been touching.
void FreeMembers::find_now(Touch& touch) const {
  const double near = world_.tolerances.touching * bricks_.thinner(touch);
  const Body* b = bricks_.second(touch);
  touch_body(bricks_.body(touch.a), b, world_.tolerances.margin * bricks_.thinner(touch), touch.now);
  touch.memory = {};
  for (int k = 0; k < touch.now.count; ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (touch.now.points[at].separation < near) touch.memory[at] = kTouching;
  }
}

}  // namespace topple::rigid
