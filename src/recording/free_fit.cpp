#include "recording/free_fit.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <span>

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

using Four = float __attribute__((vector_size(16)));
using Two = double __attribute__((vector_size(16)));
using Signs = std::int32_t __attribute__((vector_size(16)));

inline Two two_from(const double& first) {
  Two pair;
  std::memcpy(&pair, &first, sizeof pair);
  return pair;
}
inline Four four_from(const float& first) {
  Four four;
  std::memcpy(&four, &first, sizeof four);
  return four;
}
inline Four singles(const Two& a, const Two& b) {
  return Four{static_cast<float>(a[0]), static_cast<float>(a[1]), static_cast<float>(b[0]), static_cast<float>(b[1])};
}
inline Two low(const Four& four) { return Two{double{four[0]}, double{four[1]}}; }
inline Two high(const Four& four) { return Two{double{four[2]}, double{four[3]}}; }

inline float sum(const Four& four) {
  const Four pairs = four + __builtin_shufflevector(four, four, 1, 0, 3, 2);
  return pairs[0] + pairs[2];
}

// Each part with the sign that it has, turned where `signs` has the sign's bit.
inline Four turned(const Four& four, const Signs& signs) { return reinterpret_cast<Four>(reinterpret_cast<Signs>(four) ^ signs); }

constexpr std::int32_t kSign = std::numeric_limits<std::int32_t>::min();
constexpr Signs kNoTime{0, -1, -1, -1};

// The derivative by time of an orientation q: half the angular velocity (x, y, z) times it.
inline Four derivative(const Four& q, float x, float y, float z) {
  const Four by_x = turned(__builtin_shufflevector(q, q, 1, 0, 3, 2), Signs{kSign, 0, kSign, 0});
  const Four by_y = turned(__builtin_shufflevector(q, q, 2, 3, 0, 1), Signs{kSign, 0, 0, kSign});
  const Four by_z = turned(__builtin_shufflevector(q, q, 3, 2, 1, 0), Signs{kSign, kSign, 0, 0});
  return (0.5F * x) * by_x + (0.5F * y) * by_y + (0.5F * z) * by_z;
}

// The nearest multiples of the steps, powers of two; as rounded() of one number.
inline Two rounded(const Two& value, const Two& steps) {
  constexpr double kShift = 0x1.8p52;
  return (value * (1.0 / steps) + kShift - kShift) * steps;
}

/// The numbers of a knot four at a time.
struct Fours {
  Four place, turn, velocity;
  Two rate_yz;
};

inline FreeKnot knot_from(const Fours& fours) {
  FreeKnot knot;
  std::memcpy(&knot.time, &fours.place, sizeof(Four));
  std::memcpy(&knot.qw, &fours.turn, sizeof(Four));
  std::memcpy(&knot.vx, &fours.velocity, sizeof(Four));
  knot.wy = static_cast<float>(fours.rate_yz[0]);
  knot.wz = static_cast<float>(fours.rate_yz[1]);
  return knot;
}

}  // namespace

void FreeFit::open(BrickId brick, double time, const FreeKnot& first, const Vec3& put, const Accuracy& accuracy) {
  brick_ = brick;
  put_ = {Two{time, put.x}, Two{put.y, put.z}};
  const double length = kMargin * accuracy.length;
  // A corner is off by at most |place| + 2 reach |turn|, the square of which is at most twice the sum of their squares.
  most_square_ = static_cast<float>(0.5 * length * length);
  reach_square_ = static_cast<float>(4.0 * accuracy.reach * accuracy.reach);
  round_ = length >= FreeSteps::kFinestTolerance && length / accuracy.reach >= FreeSteps::kFinestTurn;
  samples_.clear();
  knots_.clear();
  FreeKnot knot = first;
  knot.time = 0.0F;
  if (round_) {
    // The turn of a brick that was put down askew is no multiple of a step; all else is, and the track is kept in steps or not at all.
    for (const auto part : {&FreeKnot::qw, &FreeKnot::qx, &FreeKnot::qy, &FreeKnot::qz}) {
      knot.*part = static_cast<float>(topple::rounded(double{knot.*part}, FreeSteps::kTurn));
    }
  }
  push_knot(knot);
}

// The segments that follow start from this knot, as it is kept.
void FreeFit::push_knot(const FreeKnot& knot) {
  knots_.push_back(knot);
  const Four place = four_from(knot.time);
  last_ = {low(place), high(place)};
  base_.turn = four_from(knot.qw);
  const Four velocity = four_from(knot.vx);
  base_.velocity = __builtin_shufflevector(velocity, velocity, 3, 0, 1, 2);
  base_.spin = derivative(base_.turn, knot.wx, knot.wy, knot.wz);
  good_ = 1;  // Nothing lies between two neighbours.
  next_test_ = kFirstTest;
}

void FreeFit::add(double time, const FreeMotion& motion) {
  const Vec3& p = motion.pose.position;
  const Quat& q = motion.pose.orientation;
  const Vec3& v = motion.velocity;
  const Vec3& w = motion.angular_velocity;
  Four turn = singles(two_from(q.w), two_from(q.y));
  // q and -q are one orientation; the one that is nearer to the last.
  const float along = sum(turn * (samples_.empty() ? base_.turn : samples_.back().turn));
  const std::int32_t sign = std::bit_cast<std::int32_t>(along) & kSign;
  turn = turned(turn, Signs{sign, sign, sign, sign});
  const Two rate_yz = two_from(w.y);
  const Four velocity = singles(Two{w.x, v.x}, two_from(v.y));
  samples_.push_back({.place = singles(Two{time, p.x} - put_.time_x - last_.time_x, two_from(p.y) - put_.yz - last_.yz),
                      .turn = turn,
                      .velocity = velocity,
                      .spin = derivative(turn, velocity[0], static_cast<float>(rate_yz[0]), static_cast<float>(rate_yz[1])),
                      .rate_yz = rate_yz,
                      .rate_x = w.x});
  if (samples_.size() >= next_test_) test();
}

// Doubles what is known to fit, or ends the segment where it does not any more.
void FreeFit::test() {
  while (samples_.size() >= next_test_) {
    const std::size_t asked = next_test_;
    if (!fits(asked)) {
      cut(longest(good_, asked));
    } else if (asked >= kMostSamples) {
      cut(asked);
    } else {
      good_ = asked;
      next_test_ = 2 * asked;
    }
  }
}

FreeKnot FreeFit::knot_of(const Sample& sample) const {
  constexpr Two kTimeX{FreeSteps::kTime, FreeSteps::kPlace}, kPlaces{FreeSteps::kPlace, FreeSteps::kPlace},
      kTurns{FreeSteps::kTurn, FreeSteps::kTurn}, kVelocities{FreeSteps::kVelocity, FreeSteps::kVelocity},
      kVelocityRate{FreeSteps::kVelocity, FreeSteps::kRate}, kRates{FreeSteps::kRate, FreeSteps::kRate};
  const Two time_x = last_.time_x + low(sample.place), yz = last_.yz + high(sample.place);
  const Four velocity = __builtin_shufflevector(sample.velocity, sample.velocity, 1, 2, 3, 0);
  if (!round_) return knot_from({singles(time_x, yz), sample.turn, velocity, sample.rate_yz});
  const Two velocity_rate{double{velocity[2]}, sample.rate_x};
  return knot_from({singles(rounded(time_x, kTimeX), rounded(yz, kPlaces)),
                    singles(rounded(low(sample.turn), kTurns), rounded(high(sample.turn), kTurns)),
                    singles(rounded(low(velocity), kVelocities), rounded(velocity_rate, kVelocityRate)), rounded(sample.rate_yz, kRates)});
}

// Whether the cubics from the last knot to sample count - 1 pass all samples before it. The rounding of the knot that would be kept there
// is far below the tolerance, and so is what normalising the quaternion between two knots changes.
bool FreeFit::fits(std::size_t count) const {
  const Sample& last = samples_[count - 1];
  const float span = last.place[0];
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
  for (const Sample& sample : std::span(samples_).first(count - 1)) {
    const float u = sample.place[0] * per;
    const Four off = u * (place1 + u * (place2 + u * place3)) - sample.place;
    const Four turn = base_.turn + u * (turn1 + u * (turn2 + u * turn3)) - sample.turn;
    if (!(sum(reinterpret_cast<Four>(reinterpret_cast<Signs>(off * off) & kNoTime) + reach_square_ * (turn * turn)) <= most_square_)) {
      return false;
    }
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
  const Moment old = last_;
  push_knot(knot_of(samples_[count - 1]));
  const Four shift = singles(last_.time_x - old.time_x, last_.yz - old.yz);
  const std::size_t left = samples_.size() - count;
  for (std::size_t i = 0; i < left; ++i) {
    samples_[i] = samples_[i + count];
    samples_[i].place -= shift;
  }
  samples_.resize(left);
  if (knots_.size() < kMostKnots && last_.time_x[0] <= kLongestPiece) return;
  FreeKnot last = knots_.back();
  const double end = start() + last_.time_x[0];
  finish_piece();
  put_.time_x[0] = end;
  last.time = 0.0F;
  push_knot(last);
}

void FreeFit::finish_piece() {
  if (knots_.empty()) return;
  const std::size_t before = code_.size();
  encode(knots_, code_);
  finished_.push_back({start(), code_.size() - before});
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
    cut(all == 1 || fits(all) ? all : longest(good_, all));
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
