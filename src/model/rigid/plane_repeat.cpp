// Even rows: what a plane front does not compute again.
//
// Some dozens of strikes into an even row a front is, right after a strike, what it was right after the strike before: all that was there
// before has been forgotten, at a rate that a row's friction and gap set. Once every number is within a hundred-millionth of what it was,
// it is made exactly that. Then all that follows until the next strike follows again, one brick further, and so on to the row's end: only
// names and times are new. Drifts begin at the strikes (plane_step.cpp), not at the steps, and places count from the brick that was struck;
// without that no two strikes would be alike.
#include <algorithm>
#include <cmath>

#include "model/rigid/plane_front.h"

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

// The last thing in the drift that ends with a strike.
void PlaneFront::after_strike() {
  const Struck struck = struck_now_.back();
  count_from(bricks_[static_cast<std::size_t>(place_of(struck.brick))]);
  const bool single = struck_now_.size() == 1 && forces_.empty() && planned_for_ > 0.0;
  even_ = single && is_even(struck) ? even_ + 1 : 0;
  if (even_ > 1 && cycle_.whole && is_as_kept()) {
    take_kept(struck.brick);
    even_to_ = struck.brick;
    if (world_.repeats && next_is_alike()) begin_repeat();
  } else if (even_ > 0) {
    kept_.all() = state();
  }
  if (repeat_.on) return;
  cycle_.first = struck.brick;
  cycle_.count = 0;
  cycle_.whole = true;
}

// Whether a brick was struck by the one beside it in the row, from which it stands as far as that one did from the one before.
bool PlaneFront::is_even(const Struck& struck) {
  const BrickId way = struck.brick - struck.by;
  if (std::abs(way) != 1) return false;
  const double pitch = -bricks_[static_cast<std::size_t>(place_of(struck.by))].stand;
  const bool even = way == way_ && std::abs(pitch - even_pitch_) < kSamePitch;
  way_ = way;
  even_pitch_ = pitch;
  return even;
}

bool PlaneFront::is_as_kept() const {
  const BrickId apart = last_struck_ - kept_.last_struck;
  const BrickKind& kind = world_.kind_of(last_struck_);
  const Grain grain(std::max({kind.height, kind.width, kind.thickness}), kind.mass, world_.gravity);
  if (apart != way_ || bricks_.size() != kept_.bricks.size() || touches_.size() != kept_.touches.size()) return false;
  for (std::size_t i = bricks_.size(); i-- > 0;) {
    if (!same(kept_.bricks[i], bricks_[i], apart, grain)) return false;
  }
  for (std::size_t i = touches_.size(); i-- > 0;) {
    if (!same(kept_.touches[i], touches_[i], grain)) return false;
  }
  for (std::size_t i = 0; i < leaps_.size(); ++i) {
    if (!same(kept_.leaps[i], leaps_[i])) return false;
  }
  return same(kept_.strike, strike_) && kept_.since_strike == since_strike_ && kept_.cuts == cuts_ && kept_.rested == rested_ &&
         Grain::near(kept_.planned_for, planned_for_, grain.time) && Grain::near(kept_.since_look, since_look_, grain.time);
}

// From now on all is as it was, but for the names.
void PlaneFront::take_kept(BrickId struck) {
  rename_kept(struck);
  state() = kept_.all();
  for (std::size_t i = 0; i < bricks_.size(); ++i) world_.note_place(bricks_[i].id, static_cast<int>(i));
}

void PlaneFront::rename_kept(BrickId struck) {
  for (PlaneBrick& brick : kept_.bricks) brick.id += struck - kept_.last_struck;
  kept_.last_struck = struck;
}

// ---- A cycle is written down, drift by drift ----

PlaneFront::Marks PlaneFront::marks() const {
  return {ledger_.taken.size(), ledger_.left.size(), ledger_.woken.size(), ledger_.rested.size(), events_.size(), rested_now_.size()};
}

void PlaneFront::write_down_places() {
  if (cycle_.count == cycle_.drifts.size()) cycle_.drifts.emplace_back();
  PlaneCycle::Drift& drift = cycle_.drifts[cycle_.count++];
  drift.whole = drift_.whole;
  drift.cut = drift_.cut;
  drift.places.clear();
  drift.arrivals.clear();
  drift.moves.clear();
  for (const PlaneBrick& brick : bricks_) {
    if (!brick.moving) continue;
    drift.places.push_back(
        {brick.id - last_struck_, brick.landed, brick.quiet, brick.stand, brick.box.place, brick.velocity, brick.middle, brick.listed_at});
  }
}

void PlaneFront::write_down_end(const Marks& before) {
  PlaneCycle::Drift& drift = cycle_.drifts[cycle_.count - 1];
  const BrickId first = cycle_.first;
  const Marks now = marks();
  cycle_.whole = cycle_.whole && now.taken >= before.taken && now.left >= before.left && now.rested >= before.rested &&
                 now.rested - before.rested == now.still - before.still;
  if (!cycle_.whole) return;
  const auto numbered = [first](const std::vector<BrickId>& from, std::size_t begin, std::vector<int>& out) {
    out.clear();
    for (std::size_t i = begin; i < from.size(); ++i) out.push_back(from[i] - first);
  };
  const auto along = [this](const Vec3& at) { return dot(at - plane_.origin, plane_.along) - origin_; };
  numbered(ledger_.taken, before.taken, drift.taken);
  numbered(ledger_.left, before.left, drift.left);
  numbered(ledger_.woken, before.woken, drift.woken);
  drift.rested.assign(rested_now_.begin() + static_cast<std::ptrdiff_t>(before.still), rested_now_.end());
  for (PlaneBrick& brick : drift.rested) brick.id -= first;
  drift.events.clear();
  for (std::size_t i = before.events; i < events_.size(); ++i) {
    if (events_[i].kind == EventKind::arrived) continue;  // Amid the drift.
    PlaneCycle::Happening happening{events_[i], events_[i].by == kNoBrick, std::isfinite(events_[i].point.x)};
    happening.event.brick -= first;
    happening.event.by -= first;
    happening.event.point.x = along(events_[i].point);
    drift.events.push_back(happening);
  }
}

// ---- It is told again, brick by brick ----

void PlaneFront::begin_repeat() {
  for (std::size_t i = 0; i < cycle_.count; ++i) {
    std::vector<PlaneCycle::Arrival>& arrivals = cycle_.drifts[i].arrivals;
    std::sort(arrivals.begin(), arrivals.end(), [](const auto& l, const auto& r) { return l.time < r.time; });
  }
  repeat_.on = true;
  repeat_.drift = repeat_.arrivals = 0;
  repeat_.like = last_struck_;
  repeat_.like_struck = now_;
  repeat_.strikes = 0;
  repeat_.times.assign(bricks_.size() + 1, now_);
  repeat_.one = bricks_[static_cast<std::size_t>(place_of(last_struck_))];
  echoed_.push_back(last_struck_);
}

double PlaneFront::struck_at(BrickId brick) const {
  return repeat_.times[static_cast<std::size_t>(way_ * (brick - repeat_.like)) % repeat_.times.size()];
}

// Whether a brick's motion is left to an echo.
bool PlaneFront::is_unseen(BrickId brick) const { return repeat_.on && way_ * (brick - repeat_.like) > 0; }

// Tells what is done again up to a moment; whether that was reached.
bool PlaneFront::repeat_to(double moment) {
  while (repeat_.on) {
    const PlaneCycle::Drift& drift = cycle_.drifts[repeat_.drift];
    drift_ = {.under_way = true, .whole = drift.whole, .cut = drift.cut, .done = std::min(moment - now_, drift.cut)};
    for (; repeat_.arrivals < drift.arrivals.size() && drift.arrivals[repeat_.arrivals].time <= drift_.done; ++repeat_.arrivals) {
      const PlaneCycle::Arrival& arrival = drift.arrivals[repeat_.arrivals];
      note_arrival(last_struck_ + arrival.brick, now_ + arrival.time);
    }
    if (now_ + drift.cut > moment + 1e-9 * world_.step) return true;
    now_ += drift.cut;
    tell_end(drift);
    repeat_.arrivals = 0;
    if (++repeat_.drift == cycle_.count) repeat_strike();
  }
  return false;
}

void PlaneFront::tell_end(const PlaneCycle::Drift& drift) {
  const BrickId first = last_struck_;
  for (const int brick : drift.woken) ledger_.woken.push_back(first + brick);
  for (const int brick : drift.taken) ledger_.take(first + brick);
  for (const int brick : drift.left) ledger_.leave(first + brick);
  for (const PlaneCycle::Move& move : drift.moves) {
    ledger_.moves.push_back({first + move.brick, in_world(move.from.x, move.from.z), in_world(move.to.x, move.to.z)});
  }
  for (const PlaneBrick& numbered : drift.rested) {
    PlaneBrick& brick = rested_now_.emplace_back(numbered);
    brick.id += first;
    ledger_.rested.push_back({brick.id, pose_of(brick)});
    if (is_unseen(brick.id)) {  // Both began to be recorded within the step before this.
      echoes_.push_back({brick.id, repeat_.like, struck_at(brick.id) - world_.step, repeat_.like_struck - world_.step});
    }
  }
  for (const PlaneCycle::Happening& happening : drift.events) {
    Event& event = events_.emplace_back(happening.event);
    event.time = now_;
    event.brick += first;
    event.by = happening.by_floor ? kNoBrick : event.by + first;
    if (happening.somewhere) event.point = in_world(event.point.x, event.point.z);
  }
}

void PlaneFront::repeat_strike() {
  last_struck_ += way_;
  origin_ = stand_along(plane_, world_, last_struck_);
  for (std::size_t i = 0; i < bricks_.size(); ++i) {
    bricks_[i].id += way_;
    world_.note_place(bricks_[i].id, static_cast<int>(i));
  }
  repeat_.drift = 0;
  repeat_.times[static_cast<std::size_t>(++repeat_.strikes) % repeat_.times.size()] = now_;
  if (!next_is_alike()) end_repeat();
}

// Whether a brick was put down as the one before it, in the plane, and as far away as all are.
bool PlaneFront::goes_on_to(BrickId brick) const {
  const BrickId before = brick - way_;
  const Brick &put = world_.given(brick), &like = world_.given(before);
  if (put.kind != like.kind || put.stance != like.stance || world_.heading(brick) != world_.heading(before)) return false;
  if (!put_down_in(plane_, world_, brick)) return false;
  return std::abs(std::abs(stand_along(plane_, world_, brick) - stand_along(plane_, world_, before)) - pitch_) <= kSamePitch;
}

// Whether the row goes on evenly beyond the bricks that the front reaches until the next strike, and nothing else stands there.
bool PlaneFront::next_is_alike() {
  int farthest = 1;
  for (std::size_t i = 0; i < cycle_.count; ++i) {
    for (const int brick : cycle_.drifts[i].taken) farthest = std::max(farthest, way_ * brick);
  }
  const Part* part = world_.layout.part_of(last_struck_);
  const int beyond = farthest + 3;  // Another wave may come this way meanwhile.
  for (int i = 1; i <= beyond; ++i) {
    const BrickId next = last_struck_ + way_ * i;
    if (next < 0 || next >= world_.layout.brick_count() || world_.layout.part_of(next) != part) return false;
    const auto at = static_cast<std::size_t>(next);
    if (world_.phase[at] != Phase::standing || (world_.front[at] != kNoFront && world_.front[at] != number_)) return false;
    if (world_.arrived[at] != 0) return false;
    if (way_ * (next - even_to_) <= 0) continue;
    if (!goes_on_to(next)) return false;
    even_to_ = next;
  }
  const BrickId last = last_struck_ + way_ * beyond;
  const Vec3 centre = world_.pose[static_cast<std::size_t>(last)].position;
  const double reach = 1.6 * repeat_.one.radius + pitch_;
  world_.neighbours.near(centre, near_);
  return std::all_of(near_.begin(), near_.end(), [&](BrickId other) {
    const int ahead = way_ * (other - last_struck_);
    if (ahead <= beyond && ahead >= -static_cast<int>(bricks_.size())) return true;
    if (world_.layout.part_of(other) == part && world_.front[static_cast<std::size_t>(other)] == kNoFront && ahead > 0) return true;
    const Vec3 apart = world_.pose[static_cast<std::size_t>(other)].position - centre;
    const double far = reach + norm(half_extents(world_.kind_of(other)));
    return dot(apart, apart) > far * far || locate(other).misses;
  });
}

// From the last strike on all is computed again; what moved unseen is told.
void PlaneFront::end_repeat() {
  tell_unseen(unseen_);
  repeat_.on = false;
  energy_law_.forget();
  drift_ = {};
  rename_kept(last_struck_);
  cycle_.first = last_struck_;
  cycle_.count = 0;
}

// Amid a cycle: bricks are taken up where they are.
void PlaneFront::break_off() {
  std::vector<HandedBrick> bricks;
  std::vector<ActiveForce> forces;
  now_ += drift_.done;
  hand_over(bricks, forces);
  bricks_.clear();
  touches_.clear();
  near_pairs_.clear();
  moving_ = even_ = cuts_ = 0;
  since_look_ = planned_for_ = 0.0;
  last_struck_ = kNoBrick;
  adopt(bricks);
}

PlaneBrick PlaneFront::at_this_moment(const PlaneCycle::Place& place) const {
  PlaneBrick brick = repeat_.one;
  brick.id = last_struck_ + place.brick;
  brick.landed = place.landed;
  brick.quiet = place.quiet;
  brick.stand = place.stand;
  brick.box.place = place.place;
  brick.velocity = place.velocity;
  brick.middle = place.middle;
  brick.listed_at = place.listed_at;
  set_turn(brick.box);
  return at_this_moment(brick);
}

// Every brick that has moved unseen, at the beginnings of all drifts since it was struck.
void PlaneFront::tell_unseen(std::vector<UnseenMotion>& out) const {
  if (!repeat_.on) return;
  const auto motion_of = [this](const PlaneBrick& brick, Phase phase) {
    const PlaneVec& v = brick.velocity;
    return FreeMotion{brick.id, phase, pose_of(brick), v.x * plane_.along + Vec3{0.0, 0.0, v.z}, v.turn * plane_.across};
  };
  for (const PlaneCycle::Place& now : cycle_.drifts[repeat_.drift].places) {
    const BrickId id = last_struck_ + now.brick;
    if (!is_unseen(id)) continue;
    PlaneBrick brick = repeat_.one;
    brick.id = id;
    double time = struck_at(id);
    out.push_back({time, motion_of(brick, Phase::standing)});
    for (int behind = 0; behind <= -way_ * now.brick; ++behind) {
      const std::size_t drifts = behind < -way_ * now.brick ? cycle_.count : repeat_.drift + 1;
      for (std::size_t i = 0; i < drifts; ++i) {
        for (const PlaneCycle::Place& place : cycle_.drifts[i].places) {
          if (place.brick != -way_ * behind || (behind == 0 && i == 0)) continue;
          brick.stand = place.stand;
          brick.box.place = place.place;
          brick.velocity = place.velocity;
          set_turn(brick.box);
          out.push_back({time, motion_of(brick, Phase::falling)});
        }
        time += cycle_.drifts[i].cut;
      }
    }
  }
}

}  // namespace topple::rigid
