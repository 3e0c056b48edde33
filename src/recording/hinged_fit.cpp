#include "recording/hinged_fit.h"

#include <algorithm>
#include <cmath>

#include "recording/hermite.h"
#include "recording/knot_code.h"

namespace topple {
namespace {

constexpr std::size_t kFirstTest = 64;
constexpr std::size_t kMostSamples = 256;  // A buffer's end: longer segments gain little.
// A piece ends after so many knots, and after so long that a float's time is still far finer than the tolerance.
constexpr std::size_t kMostKnots = 240;
constexpr double kLongestPiece = 3.0;  // [s]
// A smaller jump than this fraction of the largest rate does not show in a plot.
constexpr double kRateJump = 0.02;
// A pause is held to its angle at so many moments.
constexpr int kHolds = 16;
// What is left of the tolerance for rounding in floats, and for a curve that is smooth where the motion has a jump, between two samples.
constexpr double kBetweenSamples = 0.05;
constexpr float kMargin = 0.94F;
// Samples at the ends of a curved motion's legs, which may be far apart: none of them further than this fraction of the segment.
constexpr float kDense = 1.0F / 6.0F;

using Four = float __attribute__((vector_size(16)));

Four load(const float* from) {
  Four four;
  __builtin_memcpy(&four, from, sizeof four);
  return four;
}

/// A quintic in floats, asked about many samples.
struct Curve {
  Curve(const Quintic& curve, double span)
      : per(static_cast<float>(1.0 / span)),
        c1(static_cast<float>(curve.c1)),
        c2(static_cast<float>(curve.c2)),
        c3(static_cast<float>(curve.c3)),
        c4(static_cast<float>(curve.c4)),
        c5(static_cast<float>(curve.c5)) {}

  template <typename Number>
  Number miss(Number time, Number angle) const {
    const Number u = time * per;
    const Number miss = u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5)))) - angle;
    return miss < 0.0F ? -miss : miss;
  }

  float per, c1, c2, c3, c4, c5;
};

// Largest miss of every `stride`-th four of the first `count` samples.
float worst_of_fours(const Curve& curve, const float* time, const float* angle, std::size_t count, std::size_t stride) {
  Four worst{};
  for (std::size_t i = 0; i + 4 <= count; i += 4 * stride) {
    const Four size = curve.miss(load(time + i), load(angle + i));
    worst = size > worst ? size : worst;
  }
  return std::max(std::max(worst[0], worst[1]), std::max(worst[2], worst[3]));
}

// Whether the first `count` samples lie within `tolerance` of the curve. A few are asked first: most curves that fail do so there.
bool within(const Curve& curve, const float* time, const float* angle, std::size_t count, float tolerance) {
  if (count >= 32 && worst_of_fours(curve, time, angle, count, 4) > tolerance) return false;
  if (worst_of_fours(curve, time, angle, count, 1) > tolerance) return false;
  for (std::size_t i = count / 4 * 4; i < count; ++i) {
    if (curve.miss(time[i], angle[i]) > tolerance) return false;
  }
  return true;
}

}  // namespace

inline HingedKnot HingedFit::knot(double time, double angle, double rate, double acceleration) const {
  if (round_) {
    time = rounded(time, KnotSteps::kTime);
    angle = rounded(angle, KnotSteps::kAngle);
    rate = rounded(rate, KnotSteps::kRate);
    acceleration = rounded(acceleration, KnotSteps::kAcceleration);
  }
  return {static_cast<float>(time), static_cast<float>(angle), static_cast<float>(rate), static_cast<float>(acceleration)};
}

inline HingedKnot HingedFit::knot_at(std::size_t index) const {
  return knot(base_time_ + double{times()[index]}, base_angle_ + double{angles()[index]}, double{rates()[index]},
              double{accelerations()[index]});
}

void HingedFit::open(BrickId brick, double time, const HingedState& state, double tolerance, bool again) {
  brick_ = brick;
  tolerance_ = static_cast<float>(tolerance) * kMargin;
  round_ = tolerance >= KnotSteps::kFinestTolerance;
  again_ = again;
  followed_ = false;
  turn_angle_ = state.angle;
  paused_ = false;
  start_ = time;
  count_ = good_ = 0;
  next_test_ = kFirstTest;
  top_rate_ = 0.0;
  knots_.clear();
  kinks_.clear();
  push_knot(knot(0.0, state.angle, state.rate, state.acceleration));
  fresh_ = true;
}

void HingedFit::push_knot(HingedKnot knot) {
  // Rounded from another base it may come out before the last one: then both are at one time.
  if (!knots_.empty()) knot.time = std::max(knot.time, knots_.back().time);
  knots_.push_back(knot);
  base_time_ = double{knot.time};
  base_angle_ = double{knot.angle};
  base_clock_ = start_ + base_time_;
  top_rate_ = std::max(top_rate_, std::abs(double{knot.rate}));
}

void HingedFit::grow() {
  const std::size_t room = std::max<std::size_t>(64, 2 * room_);
  auto samples = std::make_unique_for_overwrite<float[]>(4 * room);
  for (std::size_t column = 0; column < 4; ++column) {
    std::copy_n(samples_.get() + column * room_, count_, samples.get() + column * room);
  }
  samples_ = std::move(samples);
  room_ = room;
}

bool HingedFit::at(double time) const {
  const float since = static_cast<float>(time - base_clock_);
  return count_ == 0 ? since <= 0.0F : since <= times()[count_ - 1];
}

bool HingedFit::fits(std::size_t count) const {
  // Nothing lies between two neighbours; and where a float cannot tell their times apart, they are a jump.
  if (count <= 1) return true;
  const HingedKnot last = knot_at(count - 1);
  const double span = double{last.time} - base_time_;
  if (span <= 0.0) return false;
  const Quintic curve = quintic(knots_.back(), last, span);
  const bool smoothed = !kinks_.empty() && kinks_.front().index + 1 < count;
  if (smoothed && curve.most_bend() * (step_ * step_) > 8.0 * kBetweenSamples * double{tolerance_} * (span * span)) return false;
  if (followed_ && !is_dense(count)) return false;
  return within(Curve(curve, span), times(), angles(), count, tolerance_);
}

// Whether the samples are close enough to each other to say what lies between them.
bool HingedFit::is_dense(std::size_t count) const {
  const float most = kDense * times()[count - 1];
  float last = 0.0F;
  for (std::size_t i = 0; i < count; last = times()[i++]) {
    if (times()[i] - last > most) return false;
  }
  return true;
}

std::size_t HingedFit::longest(std::size_t good, std::size_t bad) const {
  // One curve rarely goes on smoothly over a jump: up to the next is asked first.
  if (!kinks_.empty() && kinks_.front().index + 1 > good && kinks_.front().index + 1 < bad) {
    const std::size_t jump = kinks_.front().index + 1;
    if (fits(jump)) return jump;
    bad = jump;
  }
  while (bad - good > 1 + good / 16) {
    const std::size_t middle = good + (bad - good) / 2;
    (fits(middle) ? good : bad) = middle;
  }
  return good;
}

// A model may not know the acceleration just after a jump. If that of the first sample explains the rates that follow much better, it is
// taken instead.
void HingedFit::refine_start() {
  fresh_ = false;
  if (count_ < 4) return;
  HingedKnot& start = knots_.back();
  const double told = double{start.acceleration};
  const double first = double{accelerations()[0]};
  if (std::abs(first - told) <= 0.1 * std::max(std::abs(first), std::abs(told))) return;
  const double change = double{rates()[3]} - double{start.rate};
  const double time = double{times()[3]};
  if (2.0 * std::abs(change - first * time) < std::abs(change - told * time)) start.acceleration = knot(0.0, 0.0, 0.0, first).acceleration;
}

void HingedFit::stretch(TrackStore& out) {
  if (fresh_) refine_start();
  while (count_ >= next_test_) {
    const std::size_t asked = next_test_;
    if (!fits(asked)) {
      cut(longest(std::max<std::size_t>(good_, 1), asked), out);
    } else if (asked >= kMostSamples) {
      cut(asked, out);
    } else {
      good_ = asked;
      next_test_ = 2 * asked;
    }
  }
}

void HingedFit::flush(TrackStore& out) {
  if (fresh_) refine_start();
  while (count_ > 0) {
    const std::size_t all = count_;
    cut(fits(all) ? all : longest(std::max<std::size_t>(good_, 1), all), out);
  }
}

// Ends a segment at sample count - 1 and lets what is left start from there.
void HingedFit::cut(std::size_t count, TrackStore& out) {
  const std::size_t index = count - 1;
  fresh_ = false;
  const double old_time = base_time_;
  const double old_angle = base_angle_;
  push_knot(knot_at(index));
  std::size_t passed = 0;
  for (const PendingKink& kink : kinks_) {
    if (kink.index > index) break;
    ++passed;
    if (kink.index != index) continue;
    push_after({0.0, kink.rate, kink.acceleration});
    fresh_ = true;
  }
  kinks_.erase(kinks_.begin(), kinks_.begin() + static_cast<std::ptrdiff_t>(passed));
  for (PendingKink& kink : kinks_) kink.index -= count;

  const auto later = static_cast<float>(base_time_ - old_time);
  const auto further = static_cast<float>(base_angle_ - old_angle);
  count_ -= count;
  for (std::size_t i = 0; i < count_; ++i) times()[i] = times()[i + count] - later;
  for (std::size_t i = 0; i < count_; ++i) angles()[i] = angles()[i + count] - further;
  std::copy_n(rates() + count, count_, rates());
  std::copy_n(accelerations() + count, count_, accelerations());
  good_ = 0;
  next_test_ = kFirstTest;
  end_long_piece(out);
}

// A knot at the time and angle of the last one: what came after a jump.
void HingedFit::push_after(const HingedState& state) {
  HingedKnot after = knot(0.0, 0.0, state.rate, state.acceleration);
  after.time = knots_.back().time;
  after.angle = knots_.back().angle;
  push_knot(after);
}

void HingedFit::end_long_piece(TrackStore& out) {
  if (knots_.size() < kMostKnots && base_time_ <= kLongestPiece) return;
  HingedKnot last = knots_.back();
  store(out);
  start_ = base_clock_;
  last.time = 0.0F;
  push_knot(last);
}

void HingedFit::store(TrackStore& out) {
  out.add(brick_, start_, knots_);
  knots_.clear();
}

// Whether a jump must be kept as one: not where the brick has hardly moved since the last, as when one that rests finds its hold again.
bool HingedFit::matters(const Kink& kink) {
  top_rate_ = std::max({top_rate_, std::abs(kink.before.rate), std::abs(kink.after.rate)});
  const bool moved = std::abs(kink.before.angle - turn_angle_) > double{tolerance_};
  turn_angle_ = kink.before.angle;
  return moved && std::abs(kink.after.rate - kink.before.rate) > kRateJump * top_rate_;
}

void HingedFit::add_kink(const Kink& kink, double step, TrackStore& out) {
  append(kink.time, kink.before);
  kinks_.push_back({count_ - 1, kink.after.rate, kink.after.acceleration});
  step_ = step;
  if (matters(kink)) {
    flush(out);
  } else if (count_ >= next_test_) {
    stretch(out);
  }
}

void HingedFit::follow(const Kink& kink, TrackStore& out) {
  followed_ = true;
  fresh_ = false;
  const double rate = std::abs(kink.after.rate - kink.before.rate);
  const double bend = std::abs(kink.after.acceleration - kink.before.acceleration);
  // A curve that ends with the rate and the acceleration from after a jump is off by at most 4/27 of the one x span and 0.0173 of the
  // other x span^2.
  const double span = kink.time - base_clock_;
  const bool small = span * (0.15 * rate + 0.02 * bend * span) <= kBetweenSamples * double{tolerance_};
  if (count_ > 0 || rate + bend == 0.0) {  // Points on the way are kept if they must be.
    add(kink.time, small ? kink.after : kink.before, out);
    if (small) return;
    flush(out);
  } else {
    const HingedState& state = small ? kink.after : kink.before;
    push_knot(knot(kink.time - start_, state.angle, state.rate, state.acceleration));
  }
  if (!small) push_after(kink.after);
  end_long_piece(out);
}

void HingedFit::pause(double time, const HingedState& state, TrackStore& out) {
  const bool stopped = count_ == 0 && knots_.back().rate == 0.0F && knots_.back().acceleration == 0.0F &&
                       std::abs(state.angle - base_angle_) <= kBetweenSamples * double{tolerance_};
  if (!stopped && !at(time)) add(time, {state.angle, 0.0, 0.0}, out);
  paused_at_ = time;
  turn_angle_ = state.angle;
  paused_ = true;
  stop();
}

void HingedFit::pause() {
  paused_at_ = base_clock_ + (count_ > 0 ? double{times()[count_ - 1]} : 0.0);
  turn_angle_ = base_angle_ + (count_ > 0 ? double{angles()[count_ - 1]} : 0.0);
  paused_ = true;
  stop();
}

// Lets the last thing taken be one of rest; after a fast one, with a jump.
void HingedFit::stop() {
  if (count_ == 0) {
    HingedKnot last = knots_.back();
    if (last.rate == 0.0F && last.acceleration == 0.0F) return;
    last.rate = last.acceleration = 0.0F;
    push_knot(last);
    return;
  }
  if (!kinks_.empty() && kinks_.back().index + 1 == count_) {
    kinks_.back().rate = kinks_.back().acceleration = 0.0;
  } else if (std::abs(double{rates()[count_ - 1]}) > kRateJump * top_rate_) {
    kinks_.push_back({count_ - 1, 0.0, 0.0});
  } else {
    rates()[count_ - 1] = accelerations()[count_ - 1] = 0.0F;
  }
  good_ = std::min(good_, count_ - 1);  // What fitted ended otherwise.
}

void HingedFit::resume(double time, TrackStore& out) {
  paused_ = false;
  const double angle = base_angle_ + (count_ > 0 ? double{angles()[count_ - 1]} : 0.0);
  const double begin = paused_at_;
  for (int i = 1; i <= kHolds; ++i) {
    const double hold = begin + (time - begin) * i / kHolds;
    if (!at(hold)) add(hold, {angle, 0.0, 0.0}, out);
  }
}

// Whether a brick that had moved before stayed within the tolerance of where it rested.
bool HingedFit::never_left() const {
  return again_ && knots_.size() == 1 &&
         std::all_of(angles(), angles() + count_, [&](float angle) { return std::abs(angle) <= tolerance_; });
}

void HingedFit::close(bool still, TrackStore& out) {
  if (!still || !never_left()) {
    flush(out);
    store(out);
  }
  brick_ = kNoBrick;
}

}  // namespace topple
