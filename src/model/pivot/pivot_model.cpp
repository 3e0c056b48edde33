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

// A brick that leans on one that leans has no motion of its own: its tilt follows from the one ahead and moves nothing, so it is looked
// at only at every eighth step (and at its kinks), some forty times finer than the fall of a brick.
constexpr std::int64_t kFollowStride = 8;

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

// A brick that follows may still have one ahead of it that it has not struck.
void PivotModel::find_watched() {
  if (!watch_anew_) return;
  watch_anew_ = false;
  watched_.clear();
  for (const std::int32_t slot : moving_.order()) {
    if (!moving_[slot].follows || moving_[slot].may_hit) watched_.push_back(slot);
  }
}

void PivotModel::turn_bricks() {
  const bool look_at_all = step_count_ % kFollowStride == 0;
  find_watched();
  const std::vector<std::int32_t>& slots = look_at_all ? moving_.order() : watched_;
  turned_.clear();
  for (const std::int32_t slot : slots) {
    Moving& moving = moving_[slot];
    if (!look_at_all && moving.follows) continue;
    if (!fall_freely(moving)) turn(moving);
    turned_.push_back(slot);
  }
}

// Whether a brick at `behind` has nothing to do with the one ahead of it, as tightest_hold() sees it.
inline bool PivotModel::out_of_reach(const Pair& pair, const Fall& behind) const {
  if (const Moving* ahead = moving_.find(pair.ahead())) {
    if (ahead->fall.theta == 0.0 && !moving_.still(pair.ahead()).struck) return true;
    return pair.clear(behind.turned, ahead->fall);
  }
  const MovingSet::Still& still = moving_.still(pair.ahead());
  return (still.tilt == 0.0F && !still.struck) || pair.clear(behind.turned, moving_.at_rest(pair.ahead()));
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
  if (const Hold hold = tightest_hold(moving, to.theta); hold.pair != nullptr && to.theta >= hold.bound.theta) {
    catch_up(moving, from, to, hold);
    lean(moving, from, hold, to.omega);
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
    // A brick ahead that moves is not copied: its numbers were written a moment ago.
    const Bound bound = ahead != nullptr ? pair.bound(moving.fall.theta, to, ahead->fall)
                                         : pair.bound(moving.fall.theta, to, moving_.at_rest(pair.ahead()));
    if (tightest.pair != nullptr && bound.theta >= tightest.bound.theta) continue;
    tightest = {bound, ahead != nullptr ? ahead->fall.omega * bound.slope : 0.0, &pair};
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
  const Hold hold = tightest_hold(moving, theta_alone);
  if (hold.pair == nullptr || hold.bound.theta > theta_alone) return false;
  if (hold.bound.on_rear_edge != moving.on_rear_edge) {
    slip_over_edge(moving, hold);
  } else {
    follow_kinks(moving, *hold.pair);
  }
  if (hold.bound.theta >= kArrivalTilt && !moving_.still(moving.brick).arrived) note_arrival(moving, from, hold.bound.theta);
  lean(moving, from, hold, omega_alone);
  return true;
}

inline void PivotModel::lean(Moving& moving, const Fall& from, const Hold& hold, double omega_alone) {
  const double omega = hold.rate < omega_alone ? hold.rate : omega_alone;
  const bool kinked = !moving.kinks.empty() && moving.kinks.back().time >= from.time;
  const double since = end_ - (kinked ? moving.kinks.back().time : from.time);
  const double earlier = kinked ? moving.kinks.back().after.rate : from.omega;
  if (since > 1e-3 * (end_ - from.time)) moving.acceleration = (omega - earlier) / since;
  moving.leaning = true;
  moving.on_rear_edge = hold.bound.on_rear_edge;
  moving.fall.time = end_;
  moving.fall.theta = hold.bound.theta;
  moving.fall.omega = omega;
  moving.fall.turned.sin = hold.bound.turned.sin;
  moving.fall.turned.cos = hold.bound.turned.cos;
}

void PivotModel::catch_up(Moving& moving, const Fall& from, const Fall& to, const Hold& hold) {
  // Both move evenly through so short a time, so the gap closes evenly too.
  const double dt = end_ - from.time;
  const double gap = (hold.bound.theta - hold.rate * dt) - from.theta;
  const double excess = to.theta - hold.bound.theta;
  const double share = gap > 0.0 && gap + excess > 0.0 ? gap / (gap + excess) : 0.0;
  const double theta = from.theta + share * (to.theta - from.theta);
  const double time = from.time + share * dt;
  kink(moving, time, {theta, from.omega + share * (to.omega - from.omega), moving.acceleration},
       {theta, std::fmin(hold.rate, to.omega), 0.0});
  MovingSet::Still& still = moving_.still(moving.brick);
  if (still.landed) return;
  still.landed = true;
  note(EventKind::landed, time, moving.brick, hold.pair->ahead());
}

void PivotModel::follow_kinks(Moving& moving, const Pair& pair) {
  const Moving* ahead = moving_.find(pair.ahead());
  if (ahead == nullptr || !pair.in_line()) return;
  for (const Kink& k : ahead->kinks) {
    if (k.time < moving.fall.time || k.time >= end_) continue;
    const Bound bound = pair.bound(0.0, kRightAngle, fall_at(k.time, k.after.angle, k.after.rate));
    kink(moving, k.time, {bound.theta, k.before.rate * bound.slope, moving.acceleration},
         {bound.theta, k.after.rate * bound.slope, moving.acceleration});
  }
}

void PivotModel::slip_over_edge(Moving& moving, const Hold& hold) {
  // The bound is continuous where the contact changes, its rate is not: where the tangents from before and after meet.
  const Fall& from = moving.fall;
  const double dt = end_ - from.time;
  const double change = from.omega - hold.rate;
  if (change == 0.0) return;
  const double since = std::clamp((hold.bound.theta - hold.rate * dt - from.theta) / change, 0.0, dt);
  const double theta = from.theta + since * from.omega;
  kink(moving, from.time + since, {theta, from.omega, moving.acceleration}, {theta, hold.rate, moving.acceleration});
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
    hash_.add(mixed(static_cast<std::uint64_t>(moving.brick), moving.fall.theta, moving.fall.omega));
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
  if (!moving.leaning || !(std::fabs(moving.fall.omega) * moving.body->settle < moving.body->slack)) return false;
  return std::all_of(moving.ahead.begin(), moving.ahead.end(), [this](const Pair& pair) {
    // One that leans on a brick which is still falling has only paused.
    const Moving* ahead = moving_.find(pair.ahead());
    return ahead == nullptr || ahead->leaning || ahead->held_up;
  });
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
    const bool followed = moving.follows;
    if (falls_on(moving)) {
      moving.follows = false;
      watch_anew_ |= followed;
      continue;
    }
    find_unsupported(moving);
    if (!at_rest(moving)) {
      moving.follows = follows(moving);
      watch_anew_ |= moving.follows != followed;
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
  if (retired_.empty()) return;
  moving_.sweep();
  watch_anew_ = true;
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
    const double slack = moving_.body_of(behind).slack;
    const Bound bound = moving.behind->bound(tilt, tilt + 2.0 * slack, moving.fall);
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
  watch_anew_ = true;
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
  out.hinged.resize(turned_.size() + retired_.size());
  // Each number goes straight to its place: a brick that is put together first and copied then waits for its own parts.
  HingedMotion* next = out.hinged.data();
  for (const std::int32_t slot : turned_) {
    const Moving& moving = moving_[slot];
    if (moving.brick == kNoBrick) continue;
    const double sign = moving.side;
    next->brick = moving.brick;
    next->phase = moving.phase;
    next->state.angle = sign * moving.fall.theta;
    next->state.rate = sign * moving.fall.omega;
    next->state.acceleration = sign * moving.acceleration;
    ++next;
  }
  next = std::copy(retired_.begin(), retired_.end(), next);
  out.hinged.resize(static_cast<std::size_t>(next - out.hinged.data()));
  if (out.energy_wanted) out.energy = energy();
}

Energy PivotModel::energy() const {
  Energy sum{.kinetic = 0.0, .potential = still_potential_, .push_work = push_work_};
  for (const std::int32_t slot : moving_.order()) {
    const Moving& moving = moving_[slot];
    sum.kinetic += 0.5 * moving.body->inertia * moving.fall.omega * moving.fall.omega;
    sum.potential += potential(*moving.body, moving.fall.turned);
  }
  return sum;
}

}  // namespace topple::pivot
