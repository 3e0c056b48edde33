#include "recording/free_fit.h"

#include <algorithm>
#include <cmath>

#include "recording/knot_code.h"

namespace topple {
namespace {

constexpr std::size_t kFirstTest = 4;
constexpr std::size_t kMostSamples = 256;  // A buffer's end: longer segments gain little.
// A piece ends after so many knots, and after so long that a float's time is still far finer than the tolerance.
constexpr std::size_t kMostKnots = 240;
constexpr double kLongestPiece = 3.0;  // [s]
// What is left of the tolerance for rounding in floats.
constexpr double kMargin = 0.96;

template <typename Four>
float sum(const Four& four) {
  return (four[0] + four[1]) + (four[2] + four[3]);
}

}  // namespace

void FreeFit::open(BrickId brick, double time, const FreeKnot& first, const Vec3& put, const Accuracy& accuracy) {
  brick_ = brick;
  put_ = put;
  start_ = time;
  const double length = kMargin * accuracy.length;
  // A corner is off by at most |place| + 2 reach |turn|, the square of which is at most twice the sum of their squares.
  most_square_ = static_cast<float>(0.5 * length * length);
  reach_square_ = static_cast<float>(4.0 * accuracy.reach * accuracy.reach);
  round_ = length >= FreeSteps::kFinestTolerance && length / accuracy.reach >= FreeSteps::kFinestTurn;
  samples_.clear();
  knots_.clear();
  FreeKnot knot = first;
  knot.time = 0.0F;
  push_knot(knot);
}

// The segments that follow start from this knot, as it is kept.
void FreeFit::push_knot(const FreeKnot& knot) {
  knots_.push_back(knot);
  base_time_ = double{knot.time};
  base_place_ = {knot.x, knot.y, knot.z};
  const Quat turn{knot.qw, knot.qx, knot.qy, knot.qz};
  const Quat spin = Quat{0.0, 0.5 * double{knot.wx}, 0.5 * double{knot.wy}, 0.5 * double{knot.wz}} * turn;
  base_.place = Four{};
  base_.turn = Four{knot.qw, knot.qx, knot.qy, knot.qz};
  base_.velocity = Four{knot.vx, knot.vy, knot.vz, 0.0F};
  base_.spin = Four{static_cast<float>(spin.w), static_cast<float>(spin.x), static_cast<float>(spin.y), static_cast<float>(spin.z)};
  good_ = 0;
  next_test_ = kFirstTest;
}

void FreeFit::add(double time, const FreeMotion& motion) {
  const auto single = [](double x) { return static_cast<float>(x); };
  const Vec3 place = motion.pose.position - put_ - base_place_;
  Quat q = motion.pose.orientation;
  // q and -q are one orientation; the one that is nearer to the last.
  const Four last = samples_.empty() ? base_.turn : samples_.back().turn;
  if (q.w * double{last[0]} + q.x * double{last[1]} + q.y * double{last[2]} + q.z * double{last[3]} < 0.0) q = {-q.w, -q.x, -q.y, -q.z};
  const Vec3& v = motion.velocity;
  const Vec3& w = motion.angular_velocity;
  const Quat spin = Quat{0.0, 0.5 * w.x, 0.5 * w.y, 0.5 * w.z} * q;
  Sample sample;
  sample.place = Four{single(place.x), single(place.y), single(place.z), single(time - start_ - base_time_)};
  sample.turn = Four{single(q.w), single(q.x), single(q.y), single(q.z)};
  sample.velocity = Four{single(v.x), single(v.y), single(v.z), 0.0F};
  sample.spin = Four{single(spin.w), single(spin.x), single(spin.y), single(spin.z)};
  sample.rate = w;
  samples_.push_back(sample);
  while (samples_.size() >= next_test_) {
    const std::size_t asked = next_test_;
    if (!fits(asked)) {
      cut(longest(std::max<std::size_t>(good_, 1), asked));
    } else if (asked >= kMostSamples) {
      cut(asked);
    } else {
      good_ = asked;
      next_test_ = 2 * asked;
    }
  }
}

FreeKnot FreeFit::knot_of(const Sample& sample) const {
  const double time = base_time_ + double{sample.place[3]};
  const Vec3 place = base_place_ + Vec3{sample.place[0], sample.place[1], sample.place[2]};
  const Four& q = sample.turn;
  const Four& v = sample.velocity;
  const Vec3& w = sample.rate;
  const auto kept = [this](double x, double step) { return static_cast<float>(round_ ? rounded(x, step) : x); };
  const auto turn = [&](float x) { return kept(double{x}, FreeSteps::kTurn); };
  const auto velocity = [&](float x) { return kept(double{x}, FreeSteps::kVelocity); };
  return {.time = kept(time, FreeSteps::kTime),
          .x = kept(place.x, FreeSteps::kPlace),
          .y = kept(place.y, FreeSteps::kPlace),
          .z = kept(place.z, FreeSteps::kPlace),
          .qw = turn(q[0]),
          .qx = turn(q[1]),
          .qy = turn(q[2]),
          .qz = turn(q[3]),
          .vx = velocity(v[0]),
          .vy = velocity(v[1]),
          .vz = velocity(v[2]),
          .wx = kept(w.x, FreeSteps::kRate),
          .wy = kept(w.y, FreeSteps::kRate),
          .wz = kept(w.z, FreeSteps::kRate)};
}

// Whether the cubics from the last knot to sample count - 1 pass all samples before it. The rounding of the knot that would be kept there
// is far below the tolerance, and so is what normalising the quaternion between two knots changes.
bool FreeFit::fits(std::size_t count) const {
  if (count <= 1) return true;  // Nothing lies between two neighbours.
  const Sample& last = samples_[count - 1];
  const float span = last.place[3];
  if (!(span > 0.0F)) return false;
  // In u = 0..1: first + u (slope + u (c2 + u c3)).
  const Four place1 = span * base_.velocity;
  const Four place2 = 3.0F * last.place - span * (2.0F * base_.velocity + last.velocity);
  const Four place3 = span * (base_.velocity + last.velocity) - 2.0F * last.place;
  const Four turned = last.turn - base_.turn;
  const Four turn1 = span * base_.spin;
  const Four turn2 = 3.0F * turned - span * (2.0F * base_.spin + last.spin);
  const Four turn3 = span * (base_.spin + last.spin) - 2.0F * turned;
  const float per = 1.0F / span;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const Sample& sample = samples_[i];
    const float u = sample.place[3] * per;
    Four off = u * (place1 + u * (place2 + u * place3)) - sample.place;
    off[3] = 0.0F;
    const Four turn = base_.turn + u * (turn1 + u * (turn2 + u * turn3)) - sample.turn;
    if (!(sum(off * off + reach_square_ * (turn * turn)) <= most_square_)) return false;
  }
  return true;
}

std::size_t FreeFit::longest(std::size_t good, std::size_t bad) const {
  while (bad - good > 1 + good / 16) {
    const std::size_t middle = good + (bad - good) / 2;
    (fits(middle) ? good : bad) = middle;
  }
  return good;
}

// Ends a segment at sample count - 1 and lets what is left start from there.
void FreeFit::cut(std::size_t count) {
  const double old_time = base_time_;
  const Vec3 old_place = base_place_;
  push_knot(knot_of(samples_[count - 1]));
  const Vec3 moved = base_place_ - old_place;
  const Four shift = {static_cast<float>(moved.x), static_cast<float>(moved.y), static_cast<float>(moved.z),
                      static_cast<float>(base_time_ - old_time)};
  samples_.erase(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(count));
  for (Sample& sample : samples_) sample.place -= shift;
  if (knots_.size() < kMostKnots && base_time_ <= kLongestPiece) return;
  FreeKnot last = knots_.back();
  const double end = start_ + base_time_;
  finish_piece();
  start_ = end;
  last.time = 0.0F;
  push_knot(last);
}

void FreeFit::finish_piece() {
  if (knots_.empty()) return;
  const std::size_t before = code_.size();
  encode(knots_, code_);
  finished_.push_back({start_, code_.size() - before});
  knots_.clear();
}

void FreeFit::store_finished(TrackStore& out) {
  std::size_t from = 0;
  for (const Finished& piece : finished_) {
    out.add_free_code(brick_, piece.start, std::span(code_).subspan(from, piece.bytes));
    from += piece.bytes;
  }
  finished_.clear();
  code_.clear();
}

void FreeFit::close(bool still) {
  while (!samples_.empty()) {
    const std::size_t all = samples_.size();
    cut(fits(all) ? all : longest(std::max<std::size_t>(good_, 1), all));
  }
  FreeKnot& last = knots_.back();
  const bool rests = last.vx == 0.0F && last.vy == 0.0F && last.vz == 0.0F && last.wx == 0.0F && last.wy == 0.0F && last.wz == 0.0F;
  if (still && !rests) {
    // It stopped within a step: two knots at one time are a jump.
    FreeKnot stopped = last;
    stopped.vx = stopped.vy = stopped.vz = stopped.wx = stopped.wy = stopped.wz = 0.0F;
    knots_.push_back(stopped);
  }
  finish_piece();
}

}  // namespace topple
