#include "recording/hinged_fit.h"

#include <cmath>

#include "recording/hermite.h"
#include "recording/knot_code.h"

namespace topple {
namespace {

constexpr std::size_t kFirstTest = 8;
constexpr std::size_t kMostSamples = 512;  // A buffer's end: longer segments gain nothing.
// A piece ends after so many knots, and after so long that a float's time is still far finer than the tolerance.
constexpr std::size_t kMostKnots = 240;
constexpr double kLongestPiece = 3.0;  // [s]
// Smaller jumps than these fractions of the largest rate and acceleration do not show in a plot.
constexpr float kRateJump = 0.02F;
constexpr float kAccelerationJump = 0.25F;
// Rounding in floats must not carry a sample over the tolerance.
constexpr float kMargin = 0.98F;

using Four = float __attribute__((vector_size(16)));

Four load(const float* from) {
  Four four;
  __builtin_memcpy(&four, from, sizeof four);
  return four;
}

// Largest distance of the first `count` samples from the curve: four at a time, the rest one by one.
float worst_miss(const Quintic& curve, double span, const float* time, const float* angle, std::size_t count) {
  const auto per = static_cast<float>(1.0 / span);
  const auto c1 = static_cast<float>(curve.c1), c2 = static_cast<float>(curve.c2), c3 = static_cast<float>(curve.c3);
  const auto c4 = static_cast<float>(curve.c4), c5 = static_cast<float>(curve.c5);
  Four worst{};
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4) {
    const Four u = load(time + i) * per;
    const Four miss = u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5)))) - load(angle + i);
    const Four size = miss < 0.0F ? -miss : miss;
    worst = size > worst ? size : worst;
  }
  float most = std::max(std::max(worst[0], worst[1]), std::max(worst[2], worst[3]));
  for (; i < count; ++i) {
    const float u = time[i] * per;
    most = std::max(most, std::abs(u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5)))) - angle[i]));
  }
  return most;
}

}  // namespace

void HingedFit::open(BrickId brick, double time, const HingedState& state, double tolerance) {
  brick_ = brick;
  tolerance_ = static_cast<float>(tolerance) * kMargin;
  round_ = tolerance >= KnotSteps::kFinestTolerance;
  start_ = time;
  count_ = good_ = 0;
  next_test_ = kFirstTest;
  top_rate_ = top_acceleration_ = 0.0F;
  knots_.clear();
  kinks_.clear();
  push_knot(knot(0.0, state));
}

void HingedFit::push_knot(const HingedKnot& knot) {
  knots_.push_back(knot);
  base_time_ = double{knot.time};
  base_angle_ = double{knot.angle};
  base_clock_ = start_ + base_time_;
}

void HingedFit::append(double time, const HingedState& state) {
  if (count_ == time_.size()) {
    const std::size_t room = std::max<std::size_t>(64, 2 * count_);
    for (auto* column : {&time_, &angle_, &rate_, &acceleration_}) column->resize(room);
  }
  const auto rate = static_cast<float>(state.rate);
  const auto acceleration = static_cast<float>(state.acceleration);
  time_[count_] = static_cast<float>(time - base_clock_);
  angle_[count_] = static_cast<float>(state.angle - base_angle_);
  rate_[count_] = rate;
  acceleration_[count_] = acceleration;
  top_rate_ = std::max(top_rate_, std::abs(rate));
  top_acceleration_ = std::max(top_acceleration_, std::abs(acceleration));
  ++count_;
}

bool HingedFit::at(double time) const {
  const float since = static_cast<float>(time - base_clock_);
  return count_ == 0 ? since <= 0.0F : since <= time_[count_ - 1];
}

HingedKnot HingedFit::knot_at(std::size_t index) const {
  return knot(base_time_ + double{time_[index]}, {base_angle_ + double{angle_[index]}, double{rate_[index]}, double{acceleration_[index]}});
}

HingedKnot HingedFit::knot(double time, const HingedState& state) const {
  if (!round_) {
    return {static_cast<float>(time), static_cast<float>(state.angle), static_cast<float>(state.rate),
            static_cast<float>(state.acceleration)};
  }
  return {static_cast<float>(rounded(time, KnotSteps::kTime)), static_cast<float>(rounded(state.angle, KnotSteps::kAngle)),
          static_cast<float>(rounded(state.rate, KnotSteps::kRate)),
          static_cast<float>(rounded(state.acceleration, KnotSteps::kAcceleration))};
}

bool HingedFit::fits(std::size_t count) const {
  // Nothing lies between two neighbours; and where a float cannot tell their times apart, they are a jump.
  if (count <= 1) return true;
  const HingedKnot last = knot_at(count - 1);
  const double span = double{last.time} - base_time_;
  if (span <= 0.0) return false;
  return worst_miss(quintic(knots_.back(), last, span), span, time_.data(), angle_.data(), count) <= tolerance_;
}

std::size_t HingedFit::longest(std::size_t good, std::size_t bad) const {
  while (bad - good > 1 + good / 16) {
    const std::size_t middle = good + (bad - good) / 2;
    (fits(middle) ? good : bad) = middle;
  }
  return good;
}

void HingedFit::stretch(TrackStore& out) {
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
  while (count_ > 0) {
    const std::size_t all = count_;
    cut(fits(all) ? all : longest(std::max<std::size_t>(good_, 1), all), out);
  }
}

// Ends a segment at sample count - 1 and lets what is left start from there.
void HingedFit::cut(std::size_t count, TrackStore& out) {
  const std::size_t index = count - 1;
  const double old_time = base_time_;
  const double old_angle = base_angle_;
  push_knot(knot_at(index));
  std::size_t passed = 0;
  for (const PendingKink& kink : kinks_) {
    if (kink.index > index) break;
    ++passed;
    if (kink.index != index) continue;
    HingedKnot after = knot(0.0, {0.0, double{kink.rate}, double{kink.acceleration}});
    after.time = knots_.back().time;
    after.angle = knots_.back().angle;
    push_knot(after);
  }
  kinks_.erase(kinks_.begin(), kinks_.begin() + static_cast<std::ptrdiff_t>(passed));
  for (PendingKink& kink : kinks_) kink.index -= count;

  const auto later = static_cast<float>(base_time_ - old_time);
  const auto further = static_cast<float>(base_angle_ - old_angle);
  count_ -= count;
  for (std::size_t i = 0; i < count_; ++i) {
    time_[i] = time_[i + count] - later;
    angle_[i] = angle_[i + count] - further;
    rate_[i] = rate_[i + count];
    acceleration_[i] = acceleration_[i + count];
  }
  good_ = 0;
  next_test_ = kFirstTest;
  if (knots_.size() >= kMostKnots || base_time_ > kLongestPiece) {
    HingedKnot last = knots_.back();
    store(out);
    start_ = base_clock_;
    last.time = 0.0F;
    push_knot(last);
  }
}

void HingedFit::store(TrackStore& out) {
  out.add(brick_, start_, knots_);
  knots_.clear();
}

bool HingedFit::matters(const Kink& kink) const {
  return std::abs(kink.after.rate - kink.before.rate) > double{kRateJump * top_rate_} ||
         std::abs(kink.after.acceleration - kink.before.acceleration) > double{kAccelerationJump * top_acceleration_};
}

void HingedFit::add_kink(const Kink& kink, TrackStore& out) {
  append(kink.time, kink.before);
  kinks_.push_back({count_ - 1, static_cast<float>(kink.after.rate), static_cast<float>(kink.after.acceleration)});
  top_rate_ = std::max(top_rate_, static_cast<float>(std::abs(kink.after.rate)));
  top_acceleration_ = std::max(top_acceleration_, static_cast<float>(std::abs(kink.after.acceleration)));
  if (matters(kink)) {
    flush(out);
  } else if (count_ >= next_test_) {
    stretch(out);
  }
}

void HingedFit::close(bool still, TrackStore& out) {
  if (still && count_ > 0 && std::abs(rate_[count_ - 1]) <= kRateJump * top_rate_) {
    rate_[count_ - 1] = acceleration_[count_ - 1] = 0.0F;
    good_ = std::min(good_, count_ - 1);  // What fitted ended otherwise.
  }
  flush(out);
  HingedKnot last = knots_.back();
  if (still && (last.rate != 0.0F || last.acceleration != 0.0F)) {
    last.rate = last.acceleration = 0.0F;
    push_knot(last);
  }
  store(out);
  brick_ = kNoBrick;
}

}  // namespace topple
