#include "model/pivot/pivot_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/trigonometry.h"

namespace topple::pivot {

namespace {

constexpr double kRightAngle = 0.5 * kPi;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// A leaning brick rests when, at its rate, it would move its upper edge by less than this fraction of its thickness in the time
// sqrt(H / g); it wakes when the brick ahead would let it move further than that. Four times finer than what a recording keeps.
constexpr double kRestTolerance = 5e-4;

// A brick that leans on one that leans has no motion of its own: its tilt follows from the one ahead and moves nothing, so it is looked
// at only at every eighth step (and at its kinks), some forty times finer than the fall of a brick.
constexpr std::int64_t kFollowStride = 8;

double rest_angle(const Body& body) { return kRestTolerance * body.size.along / body.size.up; }

}  // namespace

Result<std::unique_ptr<Model>> make_pivot_model(const Layout& layout, const PivotConfig& config) {
  auto lines = find_lines(layout);
  if (!lines) return std::unexpected(lines.error());
  return std::make_unique<PivotModel>(layout, config, std::move(*lines));
}

PivotModel::PivotModel(const Layout& layout, const PivotConfig& config, Lines lines)
    : layout_(layout), config_(config), moving_(layout, config, std::move(lines)), pushes_(layout.pushes.size()) {
  std::iota(pushes_.begin(), pushes_.end(), std::size_t{0});
  std::stable_sort(pushes_.begin(), pushes_.end(), [&](auto a, auto b) { return layout.pushes[a].at < layout.pushes[b].at; });
}

Status PivotModel::step() {
  begin_ = static_cast<double>(step_count_) * config_.time_step;
  ++step_count_;
  end_ = static_cast<double>(step_count_) * config_.time_step;
  events_.clear();
  kinks_.clear();
  retired_.clear();
  wake_unsupported();
  start_pushes();
  hand_on_hits();
  turn_bricks();
  const Status status = check_and_hash();
  rest_bricks();
  std::stable_sort(events_.begin(), events_.end(), [](const Event& a, const Event& b) { return a.time < b.time; });
  std::stable_sort(kinks_.begin(), kinks_.end(), [](const Kink& a, const Kink& b) { return a.time < b.time; });
  if (status.progress == Progress::not_finite) return status;
  const bool done = moving_.order().empty() && next_push_ == pushes_.size();
  return {.progress = done ? Progress::at_rest : Progress::running};
}

inline double PivotModel::potential(const Body& body, const SinCos& turned) const {
  const double rise = 0.5 * (body.size.up * (turned.cos - 1.0) + body.size.along * turned.sin);
  return body.mass * layout_.gravity * rise;
}

void PivotModel::turn_bricks() {
  const bool look_at_all = step_count_ % kFollowStride == 0;
  turned_.clear();
  for (const std::int32_t slot : moving_.order()) {
    if (!look_at_all && moving_[slot].follows) continue;
    Moving& moving = moving_[slot];
    if (!fall_freely(moving)) turn(moving);
    moving.kinetic = 0.5 * moving.body->inertia * moving.fall.omega * moving.fall.omega;
    moving.potential = potential(*moving.body, moving.fall.turned);
    turned_.push_back(slot);
  }
}

// Whether a brick at `behind` has nothing to do with the one ahead of it, as tightest_bound() sees it.
inline bool PivotModel::out_of_reach(const Pair& pair, const Fall& behind) const {
  if (const Moving* ahead = moving_.find(pair.ahead())) {
    if (ahead->fall.theta == 0.0 && !moving_.still(pair.ahead()).struck) return true;
    return pair.clear(behind.turned, {ahead->fall.theta, ahead->fall.omega, ahead->fall.turned});
  }
  const MovingSet::Still& still = moving_.still(pair.ahead());
  return (still.tilt == 0.0F && !still.struck) || pair.clear(behind.turned, moving_.as_ahead(pair.ahead()));
}

// What most bricks do in most steps: turn()'s answer for one that gravity alone moves, that nothing stops, and that passes nothing.
bool PivotModel::fall_freely(Moving& moving) {
  const Fall& from = moving.fall;
  const Turning& turning = moving.turning;
  if (moving.leaning || from.time < turning.push_until || from.time < begin_) return false;
  const Fall to = advance_smoothly(turning, from, end_, config_.integrator);
  if (!(to.theta > 0.0 && to.theta < kRightAngle && to.omega >= 0.0)) return false;
  for (const Pair& pair : moving.ahead) {
    if (!out_of_reach(pair, to)) return false;
  }
  moving.held_up = false;
  moving.acceleration = turning.acceleration(to.turned, end_);
  if (to.theta >= kArrivalTilt && !moving_.still(moving.brick).arrived) note_arrival(moving, from, to.theta);
  moving.fall = to;
  return true;
}

void PivotModel::turn(Moving& moving) {
  if (moving.leaning && stay_leaning(moving)) return;
  moving.leaning = false;
  while (moving.fall.time < begin_) {
    // It followed until now and parts: its own motion, step by step.
    const double next = std::fmin(begin_, moving.fall.time + config_.time_step);
    moving.fall = advance(moving.turning, moving.fall, next, config_.integrator);
  }
  const Fall from = moving.fall;
  Fall to = advance(moving.turning, from, end_, config_.integrator);
  note_end_of_push(moving, from);
  if (to.theta <= 0.0 && !(to.theta == 0.0 && to.omega > 0.0)) come_back_to_foot(moving, from, to);
  moving.held_up = to.omega < 0.0 && stop_on_brick_behind(moving, from, to);
  moving.acceleration = moving.turning.acceleration(to.turned, end_);
  if (const auto [bound, pair] = tightest_hold(moving, to.theta); pair != nullptr && to.theta >= bound.theta) {
    catch_up(moving, from, to, bound, pair->ahead());
    lean(moving, from, bound, to.omega);
    // Known only now: how the bound moves it from the moment of catching up on.
    kinks_.back().after.acceleration = moving.side * moving.acceleration;
  } else {
    if (to.theta >= kRightAngle) land(moving, from, to);
    moving.fall = to;
  }
  if (moving.fall.theta >= kArrivalTilt) note_arrival(moving, from, moving.fall.theta);
  if (from.time < moving.turning.push_until) push_work_ += moving.turning.push * moving.body->inertia * (to.theta - from.theta);
}

void PivotModel::note_end_of_push(Moving& moving, const Fall& from) {
  const double until = moving.turning.push_until;
  if (moving.turning.push == 0.0 || from.time >= until || until > end_) return;
  const Fall at = advance(moving.turning, from, until, config_.integrator);
  if (at.theta <= 0.0 || at.theta >= kRightAngle) return;
  const double after = moving.turning.acceleration(at.turned, until);
  kink(moving, until, {at.theta, at.omega, after + moving.turning.push}, {at.theta, at.omega, after});
}

void PivotModel::come_back_to_foot(Moving& moving, const Fall& from, Fall& to) {
  if (from.theta > 0.0) {
    const double share = from.theta / (from.theta - to.theta);
    const double omega = from.omega + share * (to.omega - from.omega);
    kink(moving, from.time + share * (end_ - from.time), {0.0, omega, -moving.turning.cosine}, {});
  }
  to = {.time = end_};
}

bool PivotModel::stop_on_brick_behind(const Moving& moving, const Fall& from, Fall& to) const {
  const BrickId behind = moving_.lines().behind[static_cast<std::size_t>(moving.brick)];
  if (behind == kNoBrick || moving_.tilt(behind) == 0.0) return false;
  const Pair pair(layout_, behind, moving_.lines().side[static_cast<std::size_t>(behind)], moving.brick, moving.side);
  const auto stop = pair.fall_back_stop(moving_.tilt(behind), from.theta, std::fmin(from.theta, to.theta));
  if (stop) to = fall_at(end_, *stop, 0.0);
  return stop.has_value();
}

inline PivotModel::Hold PivotModel::tightest_hold(const Moving& moving, double to) const {
  Hold tightest;
  for (const Pair& pair : moving.ahead) {
    const Moving* ahead = moving_.find(pair.ahead());
    const MovingSet::Still& still = moving_.still(pair.ahead());
    // What stands and was not struck yet is not leant on: the hit was looked for already.
    if (!still.struck && (ahead != nullptr ? ahead->fall.theta == 0.0 : still.tilt == 0.0F)) continue;
    const Ahead now = ahead != nullptr ? Ahead{ahead->fall.theta, ahead->fall.omega, ahead->fall.turned} : moving_.as_ahead(pair.ahead());
    const Bound bound = pair.bound(moving.fall.theta, to, now);
    if (tightest.pair == nullptr || bound.theta < tightest.bound.theta) tightest = {bound, &pair};
  }
  return tightest;
}

bool PivotModel::stay_leaning(Moving& moving) {
  const Fall& from = moving.fall;
  const double dt = end_ - from.time;
  const double gravity = moving.turning.acceleration(from.turned, from.time);
  // Alone it would fall so far; it parts from the brick ahead when that one leaves it more room.
  const double theta_alone = from.theta + dt * (from.omega + 0.5 * dt * gravity);
  const double omega_alone = from.omega + dt * gravity;
  const auto [bound, pair] = tightest_hold(moving, theta_alone);
  if (pair == nullptr || bound.theta > theta_alone) return false;
  if (bound.on_rear_edge != moving.on_rear_edge) {
    slip_over_edge(moving, bound);
  } else {
    follow_kinks(moving, *pair);
  }
  if (bound.theta >= kArrivalTilt && !moving_.still(moving.brick).arrived) note_arrival(moving, from, bound.theta);
  lean(moving, from, bound, omega_alone);
  return true;
}

inline void PivotModel::lean(Moving& moving, const Fall& from, const Bound& bound, double omega_alone) {
  const double omega = std::fmin(bound.rate, omega_alone);
  const bool kinked = !moving.kinks.empty() && moving.kinks.back().time >= from.time;
  const double since = end_ - (kinked ? moving.kinks.back().time : from.time);
  const double earlier = kinked ? moving.kinks.back().after.rate : from.omega;
  if (since > 1e-3 * (end_ - from.time)) moving.acceleration = (omega - earlier) / since;
  moving.leaning = true;
  moving.on_rear_edge = bound.on_rear_edge;
  moving.fall = fall_at(end_, bound.theta, omega);
}

void PivotModel::catch_up(Moving& moving, const Fall& from, const Fall& to, const Bound& bound, BrickId ahead) {
  // Both move evenly through so short a time, so the gap closes evenly too.
  const double dt = end_ - from.time;
  const double gap = (bound.theta - bound.rate * dt) - from.theta;
  const double excess = to.theta - bound.theta;
  const double share = gap > 0.0 && gap + excess > 0.0 ? gap / (gap + excess) : 0.0;
  const double theta = from.theta + share * (to.theta - from.theta);
  const double time = from.time + share * dt;
  kink(moving, time, {theta, from.omega + share * (to.omega - from.omega), moving.acceleration},
       {theta, std::fmin(bound.rate, to.omega), 0.0});
  MovingSet::Still& still = moving_.still(moving.brick);
  if (still.landed) return;
  still.landed = true;
  note(EventKind::landed, time, moving.brick, ahead);
}

void PivotModel::follow_kinks(Moving& moving, const Pair& pair) {
  const Moving* ahead = moving_.find(pair.ahead());
  if (ahead == nullptr || !pair.in_line()) return;
  for (const Kink& k : ahead->kinks) {
    if (k.time < moving.fall.time || k.time >= end_) continue;
    const SinCos turned = sin_cos(k.after.angle);
    const Bound before = pair.bound(0.0, kRightAngle, {k.before.angle, k.before.rate, turned});
    const Bound after = pair.bound(0.0, kRightAngle, {k.after.angle, k.after.rate, turned});
    kink(moving, k.time, {before.theta, before.rate, moving.acceleration}, {after.theta, after.rate, moving.acceleration});
  }
}

void PivotModel::slip_over_edge(Moving& moving, const Bound& bound) {
  // The bound is continuous where the contact changes, its rate is not: where the tangents from before and after meet.
  const Fall& from = moving.fall;
  const double dt = end_ - from.time;
  const double change = from.omega - bound.rate;
  if (change == 0.0) return;
  const double since = std::clamp((bound.theta - bound.rate * dt - from.theta) / change, 0.0, dt);
  const double theta = from.theta + since * from.omega;
  kink(moving, from.time + since, {theta, from.omega, moving.acceleration}, {theta, bound.rate, moving.acceleration});
}

void PivotModel::land(Moving& moving, const Fall& from, Fall& to) {
  const double share = to.theta > from.theta ? (kRightAngle - from.theta) / (to.theta - from.theta) : 0.0;
  const double time = from.time + share * (end_ - from.time);
  const double omega = from.omega + share * (to.omega - from.omega);
  kink(moving, time, {kRightAngle, omega, moving.turning.acceleration(to.turned, time)}, {kRightAngle, 0.0, 0.0});
  to = fall_at(end_, kRightAngle, 0.0);
  moving.acceleration = 0.0;
  MovingSet::Still& still = moving_.still(moving.brick);
  if (!still.landed) note(EventKind::landed, time, moving.brick);
  still.landed = true;
  if (!moving.ahead.empty()) return;
  for (const Part& part : layout_.parts) {
    const bool has_next = moving.brick >= part.first && moving.brick + 1 < part.first + part.count;
    if (has_next) note(EventKind::missed, time, moving.brick, moving.brick + 1);
  }
}

void PivotModel::note_arrival(const Moving& moving, const Fall& from, double to) {
  MovingSet::Still& still = moving_.still(moving.brick);
  if (still.arrived) return;
  still.arrived = true;
  const double share = to > from.theta ? std::fmax(0.0, (kArrivalTilt - from.theta) / (to - from.theta)) : 0.0;
  note(EventKind::arrived, from.time + share * (end_ - from.time), moving.brick);
}

Status PivotModel::check_and_hash() {
  Status status;
  for (const std::int32_t slot : turned_) {
    const Moving& moving = moving_[slot];
    hash_.add(static_cast<std::uint64_t>(moving.brick));
    hash_.add(moving.fall.theta);
    hash_.add(moving.fall.omega);
    if (!std::isfinite(moving.fall.theta + moving.fall.omega)) status = {Progress::not_finite, moving.brick};
  }
  return status;
}

// Whether it certainly is neither at rest nor follows, and holds nobody: a cheap first question.
inline bool PivotModel::falls_on(const Moving& moving) const {
  const bool between = moving.fall.theta > 0.0 && moving.fall.theta < kRightAngle;
  return between && moving.fall.omega >= 0.0 && !moving.leaning && !moving.held_up && !moving.behind;
}

bool PivotModel::at_rest(const Moving& moving) const {
  if (end_ < moving.turning.push_until) return false;
  if (moving.fall.theta >= kRightAngle) return true;
  if (moving.fall.theta == 0.0) return moving.fall.omega == 0.0;
  const BrickId behind = moving_.lines().behind[static_cast<std::size_t>(moving.brick)];
  if (moving.held_up) return moving_.find(behind) == nullptr;
  if (!moving.leaning) return false;
  for (const Pair& pair : moving.ahead) {
    // One that leans on a brick which is still falling has only paused.
    const Moving* ahead = moving_.find(pair.ahead());
    if (ahead != nullptr && !ahead->leaning && !ahead->held_up) return false;
  }
  return std::fabs(moving.fall.omega) * moving.body->settle < rest_angle(*moving.body);
}

bool PivotModel::follows(const Moving& moving) const {
  if (!moving.leaning || !moving_.still(moving.brick).arrived) return false;
  const Moving* behind = moving_.find_behind(moving.brick);
  if (behind != nullptr && !behind->leaning) return false;
  return std::all_of(moving.ahead.begin(), moving.ahead.end(), [this](const Pair& pair) {
    const Moving* ahead = moving_.find(pair.ahead());
    return pair.in_line() && (ahead == nullptr || ahead->leaning);
  });
}

void PivotModel::rest_bricks() {
  for (const std::int32_t slot : turned_) {
    Moving& moving = moving_[slot];
    if (falls_on(moving)) {
      moving.follows = false;
      continue;
    }
    find_unsupported(moving);
    if (!at_rest(moving)) {
      moving.follows = follows(moving);
      continue;
    }
    moving.fall.omega = 0.0;
    moving.acceleration = 0.0;
    moving.phase = moving.fall.theta == 0.0 ? Phase::standing : Phase::resting;
    retired_.push_back({moving.brick, moving.phase, state(moving)});
    still_potential_ += potential(*moving.body, moving.fall.turned);
    MovingSet::Still& still = moving_.still(moving.brick);
    if (!still.rested) note(EventKind::rested, end_, moving.brick);
    still.rested = true;
    moving_.rest(slot);
  }
  if (!retired_.empty()) moving_.sweep();
}

void PivotModel::wake_unsupported() {
  for (const BrickId brick : unsupported_) wake_or_find(brick, begin_);
  unsupported_.clear();
}

void PivotModel::find_unsupported(const Moving& moving) {
  if (moving.behind) {
    // The brick behind rests on this one, which may have moved on since.
    const BrickId behind = moving_.lines().behind[static_cast<std::size_t>(moving.brick)];
    const double tilt = moving_.tilt(behind);
    const double slack = rest_angle(moving_.body_of(behind));
    const Bound bound = moving.behind->bound(tilt, tilt + 2.0 * slack, {moving.fall.theta, moving.fall.omega, moving.fall.turned});
    if (tilt < kRightAngle && bound.theta > tilt + slack) unsupported_.push_back(behind);
  }
  if (moving.fall.omega >= 0.0) return;
  // A brick that fell back onto this one loses its hold when this one falls back too.
  for (const Pair& pair : moving.ahead) {
    const bool held = moving_.find(pair.ahead()) == nullptr && moving_.tilt(pair.ahead()) > 0.0;
    if (held && moving_.tilt(pair.ahead()) < tip_angle(moving_.body_of(pair.ahead()).size)) unsupported_.push_back(pair.ahead());
  }
}

Moving& PivotModel::wake_or_find(BrickId brick, double time) {
  if (Moving* moving = moving_.find(brick)) return *moving;
  still_potential_ -= potential(moving_.body_of(brick), sin_cos(moving_.tilt(brick)));
  return moving_.wake(brick, time);
}

void PivotModel::kink(Moving& moving, double time, const HingedState& before, const HingedState& after) {
  // Those that follow this brick were last looked at within this time.
  const double forgotten = end_ - static_cast<double>(kFollowStride + 1) * config_.time_step;
  std::erase_if(moving.kinks, [forgotten](const Kink& old) { return old.time < forgotten; });
  moving.kinks.push_back({moving.brick, time, before, after});
  const double sign = moving.side;
  kinks_.push_back({moving.brick,
                    time,
                    {sign * before.angle, sign * before.rate, sign * before.acceleration},
                    {sign * after.angle, sign * after.rate, sign * after.acceleration}});
}

void PivotModel::note(EventKind kind, double time, BrickId brick, BrickId by) {
  events_.push_back(
      {.time = time, .kind = kind, .brick = brick, .by = by, .force = kNone, .impulse = kNone, .point = {kNone, kNone, kNone}});
}

HingedState PivotModel::state(const Moving& moving) const {
  const double sign = moving.side;
  return {sign * moving.fall.theta, sign * moving.fall.omega, sign * moving.acceleration};
}

void PivotModel::read(Frame& out) const {
  out.time = end_;
  out.free.clear();
  out.kinks.assign(kinks_.begin(), kinks_.end());
  double kinetic = 0.0;
  double potential = still_potential_;
  out.hinged.resize(moving_.order().size());
  // Each number goes straight to its place: a brick that is put together first and copied then waits for its own parts.
  HingedMotion* next = out.hinged.data();
  for (const std::int32_t slot : moving_.order()) {
    const Moving& moving = moving_[slot];
    const Fall& fall = moving.fall;
    if (fall.time == end_) {
      const double sign = moving.side;
      next->brick = moving.brick;
      next->phase = moving.phase;
      next->state.angle = sign * fall.theta;
      next->state.rate = sign * fall.omega;
      next->state.acceleration = sign * moving.acceleration;
      ++next;
    }
    kinetic += moving.kinetic;
    potential += moving.potential;
  }
  out.hinged.resize(static_cast<std::size_t>(next - out.hinged.data()));
  out.hinged.insert(out.hinged.end(), retired_.begin(), retired_.end());
  out.energy = {.kinetic = kinetic, .potential = potential, .push_work = push_work_};
}

}  // namespace topple::pivot
