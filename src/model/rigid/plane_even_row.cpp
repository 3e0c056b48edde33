#include "model/rigid/plane_even_row.h"

#include <algorithm>
#include <cmath>

namespace topple::rigid {

namespace {

// Two strikes are alike when nothing differs by more than this share of its unit.
constexpr double kAlike = 1e-8;
// Of forces: a blow leaves what is many times a weight, and they are first guesses but where a brick comes to rest.
constexpr double kAlikeForce = 1e-6;

// Units of a front: differences less than this count for nothing.
struct Grain {
  double length, time, speed, rate, force;

  Grain(double height, double mass, double gravity)
      : length(kAlike * height),
        time(kAlike * std::sqrt(height / gravity)),
        speed(kAlike * std::sqrt(height * gravity)),
        rate(kAlike * std::sqrt(gravity / height)),
        force(kAlikeForce * mass * gravity) {}

  static bool near(double a, double b, double grain) { return std::abs(a - b) <= grain; }
  bool same_place(const PlaneVec& a, const PlaneVec& b) const {
    return near(a.x, b.x, length) && near(a.z, b.z, length) && near(a.turn, b.turn, kAlike);
  }
  bool same_velocity(const PlaneVec& a, const PlaneVec& b) const {
    return near(a.x, b.x, speed) && near(a.z, b.z, speed) && near(a.turn, b.turn, rate);
  }
};

bool same(const Quat& a, const Quat& b) { return a.w == b.w && a.x == b.x && a.y == b.y && a.z == b.z; }
bool same(const PointState& a, const PointState& b) { return a.pressed == b.pressed && a.grip == b.grip; }

bool same(const PlaneBrick& a, const PlaneBrick& b, BrickId apart, const Grain& grain) {
  return a.id + apart == b.id && a.kind == b.kind && a.moving == b.moving && a.landed == b.landed && !a.pushed && !b.pushed &&
         same(a.upright, b.upright) && a.aside == b.aside && grain.same_velocity(a.velocity, b.velocity) &&
         grain.same_place(a.box.place, b.box.place) && grain.same_velocity(a.middle, b.middle) &&
         grain.same_velocity(a.velocity_before, b.velocity_before) && grain.same_place(a.listed_at, b.listed_at) &&
         Grain::near(a.stand, b.stand, grain.length) && Grain::near(a.quiet, b.quiet, grain.time);
}

bool same(const PlaneMemory& a, const PlaneMemory& b, const Grain& grain) {
  return a.active == b.active && a.fresh == b.fresh && same(a.kick, b.kick) && same(a.blow, b.blow) &&
         Grain::near(a.overlap, b.overlap, grain.length) && Grain::near(a.leaning, b.leaning, grain.force) &&
         Grain::near(a.leaning_tangent, b.leaning_tangent, grain.force) && Grain::near(a.normal, b.normal, grain.force) &&
         Grain::near(a.tangent, b.tangent, grain.force);
}

bool same(const PlaneTouch& a, const PlaneTouch& b, const Grain& grain) {
  bool points = a.now.count == b.now.count && a.now.axis == b.now.axis;
  for (std::size_t k = 0; points && k < static_cast<std::size_t>(a.now.count); ++k) {
    points = a.now.points[k].feature == b.now.points[k].feature && same(a.memory[k], b.memory[k], grain);
  }
  return points && a.a == b.a && a.b == b.b && a.bearing == b.bearing && grain.same_place(a.mark, b.mark);
}

bool same(const Pattern& a, const Pattern& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const PatternPoint& l, const PatternPoint& r) {
    return l.a == r.a && l.b == r.b && l.feature == r.feature && same(l.state, r.state);
  });
}

}  // namespace

void PlaneEvenRow::count(const Struck& struck, bool single) { strikes_ = single && is_even(struck) ? strikes_ + 1 : 0; }

// Whether a brick was struck by the one beside it in the row, from which it stands as far as that one did from the one before.
bool PlaneEvenRow::is_even(const Struck& struck) {
  const BrickId way = struck.brick - struck.by;
  if (std::abs(way) != 1) return false;
  const double pitch = -state_.brick(state_.place_of(struck.by)).stand;
  const bool even = way == way_ && std::abs(pitch - pitch_) < kSamePitch;
  way_ = way;
  pitch_ = pitch;
  return even;
}

bool PlaneEvenRow::is_as_kept() const {
  const BrickId apart = state_.last_struck - kept_.last_struck;
  const BrickKind& kind = world_.kind_of(state_.last_struck);
  const Grain grain(std::max({kind.height, kind.width, kind.thickness}), kind.mass, world_.gravity);
  if (apart != way_ || state_.bricks.size() != kept_.bricks.size() || state_.touches.size() != kept_.touches.size()) return false;
  for (std::size_t i = state_.bricks.size(); i-- > 0;) {
    if (!same(kept_.bricks[i], state_.bricks[i], apart, grain)) return false;
  }
  for (std::size_t i = state_.touches.size(); i-- > 0;) {
    if (!same(kept_.touches[i], state_.touches[i], grain)) return false;
  }
  for (std::size_t i = 0; i < state_.leaps.size(); ++i) {
    if (!same(kept_.leaps[i], state_.leaps[i])) return false;
  }
  return same(kept_.strike, state_.strike) && kept_.since_strike == state_.since_strike && kept_.cuts == state_.cuts &&
         kept_.rested == state_.rested && Grain::near(kept_.planned_for, state_.planned_for, grain.time) &&
         Grain::near(kept_.since_look, state_.since_look, grain.time);
}

void PlaneEvenRow::take_kept() {
  rename_kept(state_.last_struck);
  state_ = kept_;
  for (std::size_t i = 0; i < state_.bricks.size(); ++i) world_.note_place(state_.bricks[i].id, static_cast<int>(i));
  to_ = state_.last_struck;
}

void PlaneEvenRow::rename_kept(BrickId struck) {
  for (PlaneBrick& brick : kept_.bricks) brick.id += struck - kept_.last_struck;
  kept_.last_struck = struck;
}

bool PlaneEvenRow::goes_on(const PlaneCycle& cycle) {
  int farthest = 1;
  for (const PlaneCycle::Drift& drift : cycle.drifts()) {
    for (const int brick : drift.taken) farthest = std::max(farthest, way_ * brick);
  }
  const Part* part = world_.layout.part_of(state_.last_struck);
  const int beyond = farthest + 3;  // Another wave may come this way meanwhile.
  for (int i = 1; i <= beyond; ++i) {
    const BrickId next = state_.last_struck + way_ * i;
    if (next < 0 || next >= world_.layout.brick_count() || world_.layout.part_of(next) != part || !is_untouched(next)) return false;
    if (way_ * (next - to_) <= 0) continue;
    if (!is_put_down_alike(next)) return false;
    to_ = next;
  }
  return nothing_else_is_near(beyond);
}

// Whether it stands, and no other wave has reached it.
bool PlaneEvenRow::is_untouched(BrickId brick) const {
  const auto at = static_cast<std::size_t>(brick);
  return world_.phase[at] == Phase::standing && (world_.front[at] == kNoFront || world_.front[at] == ledger_.front) &&
         world_.arrived[at] == 0;
}

// Whether a brick was put down as the one before it, in the plane, and as far away as all are.
bool PlaneEvenRow::is_put_down_alike(BrickId brick) const {
  const BrickId before = brick - way_;
  const Brick &put = world_.given(brick), &like = world_.given(before);
  if (put.kind != like.kind || put.stance != like.stance || world_.heading(brick) != world_.heading(before)) return false;
  if (!put_down_in(plane_, world_, brick)) return false;
  return std::abs(std::abs(stand_along(plane_, world_, brick) - stand_along(plane_, world_, before)) - plane_.pitch) <= kSamePitch;
}

// Besides the row: where it is reached when the brick so many beyond the one that was struck is.
bool PlaneEvenRow::nothing_else_is_near(int beyond) {
  const BrickId last = state_.last_struck + way_ * beyond;
  const Part* part = world_.layout.part_of(last);
  const Vec3 centre = world_.pose[static_cast<std::size_t>(last)].position;
  const double reach = 1.6 * state_.brick(state_.place_of(state_.last_struck)).radius + plane_.pitch;
  world_.neighbours.near(centre, near_);
  return std::all_of(near_.begin(), near_.end(), [&](BrickId other) {
    const int ahead = way_ * (other - state_.last_struck);
    if (ahead <= beyond && ahead >= -static_cast<int>(state_.bricks.size())) return true;
    if (world_.layout.part_of(other) == part && world_.front[static_cast<std::size_t>(other)] == kNoFront && ahead > 0) return true;
    const Vec3 apart = world_.pose[static_cast<std::size_t>(other)].position - centre;
    const double far = reach + norm(half_extents(world_.kind_of(other)));
    return dot(apart, apart) > far * far || locate_in(plane_, world_, other, still(world_, ledger_, other)).misses;
  });
}

}  // namespace topple::rigid
