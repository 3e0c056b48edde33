#include "recording/free_code.h"

#include <cstring>

#include "recording/knot_code.h"

namespace topple::free_code {
namespace {

// Four numbers of a knot at once. In lanes since recordings of bricks that move freely are mostly this: 14 numbers a knot, one of three
// steps of the model.
using Four = float __attribute__((vector_size(16)));
using Whole = std::int32_t __attribute__((vector_size(16)));
using Bits = std::uint32_t __attribute__((vector_size(16)));

constexpr std::size_t kParts = 14;
static_assert(sizeof(FreeKnot) == kParts * sizeof(float), "its numbers are read four at a time");

/// A knot in steps, less than 2^24 of each.
struct Steps {
  Whole place{};     // Time, x, y, z.
  Whole turn{};      // w, x, y, z.
  Whole velocity{};  // x, y, z, and the first of the rates.
  Whole rate{};      // Nothing, nothing, and the other two.
};

constexpr auto kTime = static_cast<float>(FreeSteps::kTime), kPlace = static_cast<float>(FreeSteps::kPlace),
               kTurn = static_cast<float>(FreeSteps::kTurn), kVelocity = static_cast<float>(FreeSteps::kVelocity),
               kRate = static_cast<float>(FreeSteps::kRate);

// A float has each multiple of a step, a power of two, up to 2^24 of them, and so has its product with one over the step.
inline Whole to_whole(const Four& exact, Whole& good) {
  constexpr float kMost = 0x1p24F;
  const Whole within = (exact < kMost) & (exact > -kMost);
  const Whole whole = __builtin_convertvector(reinterpret_cast<Four>(reinterpret_cast<Whole>(exact) & within), Whole);
  good &= within & (__builtin_convertvector(whole, Four) == exact);
  return whole;
}

inline bool all(const Whole& truths) {
  std::uint64_t halves[2];
  std::memcpy(&halves, &truths, sizeof halves);
  return (halves[0] & halves[1]) == ~std::uint64_t{0};
}

inline Steps to_steps(const FreeKnot& knot, Whole& good) {
  Four four[3];
  std::memcpy(&four, &knot, sizeof four);
  const Four rest{0.0F, 0.0F, knot.wy, knot.wz};
  return {to_whole(four[0] * Four{1.0F / kTime, 1.0F / kPlace, 1.0F / kPlace, 1.0F / kPlace}, good),
          to_whole(four[1] * (1.0F / kTurn), good),
          to_whole(four[2] * Four{1.0F / kVelocity, 1.0F / kVelocity, 1.0F / kVelocity, 1.0F / kRate}, good),
          to_whole(rest * (1.0F / kRate), good)};
}

inline FreeKnot to_knot(const Steps& steps) {
  const Four four[3] = {__builtin_convertvector(steps.place, Four) * Four{kTime, kPlace, kPlace, kPlace},
                        __builtin_convertvector(steps.turn, Four) * kTurn,
                        __builtin_convertvector(steps.velocity, Four) * Four{kVelocity, kVelocity, kVelocity, kRate}};
  FreeKnot knot;
  std::memcpy(static_cast<void*>(&knot), &four, sizeof four);
  knot.wy = static_cast<float>(steps.rate[2]) * kRate;
  knot.wz = static_cast<float>(steps.rate[3]) * kRate;
  return knot;
}

// Where the mean of two velocities would bring the place in the time between; the time itself as before. Any guess will do that both
// directions make alike, so singles are good enough.
inline Whole expected_place(const Steps& last, const Whole& velocity, std::int32_t time) {
  constexpr auto kMean = static_cast<float>(0.5 * FreeSteps::kVelocity * FreeSteps::kTime / FreeSteps::kPlace);
  constexpr float kMost = 0x1p24F;
  const Whole sum = last.velocity + velocity;
  const Whole sums = __builtin_shufflevector(sum, sum, 3, 0, 1, 2);
  const float span = static_cast<float>(time - last.place[0]) * kMean;
  Four change = __builtin_convertvector(sums, Four) * Four{0.0F, span, span, span};
  change = change < kMost ? change : Four{kMost, kMost, kMost, kMost};
  change = change > -kMost ? change : -Four{kMost, kMost, kMost, kMost};
  return last.place + __builtin_convertvector(change, Whole);
}

// The sign becomes the lowest bit, and back.
inline Bits unsigned_of(const Whole& value) { return reinterpret_cast<Bits>((value << 1) ^ (value >> 31)); }
inline Whole signed_of(const Bits& value) { return reinterpret_cast<Whole>(value >> 1) ^ -reinterpret_cast<Whole>(value & 1U); }

// How many bytes of a number are not zero; less than 2^24 each.
inline Bits bytes_of(const Bits& value) {
  const Whole number = reinterpret_cast<Whole>(value);
  return reinterpret_cast<Bits>(-((number > 0) + (number > 0xFF) + (number > 0xFFFF)));
}

// A word with two bits for each number, how many bytes it has, and then the bytes.
inline bool put_next(std::uint8_t*& out, const Steps& last, const Steps& now) {
  const Bits numbers[4] = {unsigned_of(now.place - expected_place(last, now.velocity, now.place[0])), unsigned_of(now.turn - last.turn),
                           unsigned_of(now.velocity - last.velocity), unsigned_of(now.rate - last.rate)};
  const Whole fit = reinterpret_cast<Whole>(numbers[0] | numbers[1] | numbers[2] | numbers[3]) < (1 << 24);
  const Bits bytes[4] = {bytes_of(numbers[0]), bytes_of(numbers[1]), bytes_of(numbers[2]), bytes_of(numbers[3])};
  const Bits four = bytes[0] | (bytes[1] << 8) | (bytes[2] << 16) | (bytes[3] << 24);
  // Through memory, which is faster than lane by lane.
  std::uint32_t number[16], count[16], words[4];
  std::memcpy(&number, &numbers, sizeof number);
  std::memcpy(&count, &bytes, sizeof count);
  std::memcpy(&words, &four, sizeof words);
  const std::uint32_t word = words[0] | (words[1] << 2) | (words[2] << 4) | (words[3] << 6);
  std::uint8_t* next = out;
  std::memcpy(next, &word, sizeof word);
  next += sizeof word;
  for (std::size_t i = 0; i < kParts + 2; ++i) {
    if (i == 12 || i == 13) continue;
    std::memcpy(next, &number[i], sizeof number[i]);
    next += count[i];
  }
  out = next;
  return all(fit);
}

// The number that ends at `code` after so many bytes: read with what is before it, since behind it there may be nothing.
inline std::uint32_t get_bytes(const std::uint8_t*& code, std::uint32_t bytes) {
  std::uint32_t word;
  code += bytes;
  std::memcpy(&word, code - sizeof word, sizeof word);
  return static_cast<std::uint32_t>((std::uint64_t{word} << (8 * bytes)) >> 32);
}

inline Steps get_next(const std::uint8_t*& code, const Steps& last) {
  std::uint32_t word;
  std::memcpy(&word, code, sizeof word);
  code += sizeof word;
  std::uint32_t numbers[4][4] = {};
  for (unsigned i = 0; i < kParts + 2; ++i) {
    if (i == 12 || i == 13) continue;
    numbers[i / 4][i % 4] = get_bytes(code, (word >> (8 * (i / 4) + 2 * (i % 4))) & 3U);
  }
  Bits change[4];
  std::memcpy(&change, &numbers, sizeof change);
  Steps now{{}, last.turn + signed_of(change[1]), last.velocity + signed_of(change[2]), last.rate + signed_of(change[3])};
  const Whole place = signed_of(change[0]);
  now.place = expected_place(last, now.velocity, last.place[0] + place[0]) + place;
  return now;
}

}  // namespace

bool put(std::span<const FreeKnot> knots, std::uint8_t*& out) {
  Whole good = ~Whole{};
  bool fit = put_next(out, {}, to_steps(knots.back(), good));
  Steps last;
  for (const FreeKnot& knot : knots.first(knots.size() - 1)) {
    const Steps now = to_steps(knot, good);
    fit &= put_next(out, last, now);
    last = now;
  }
  return fit && all(good);
}

FreeKnot get_last(const std::uint8_t* code) { return to_knot(get_next(code, {})); }

void get(const std::uint8_t* code, std::span<FreeKnot> knots) {
  knots.back() = to_knot(get_next(code, {}));
  Steps last;
  for (FreeKnot& knot : knots.first(knots.size() - 1)) {
    last = get_next(code, last);
    knot = to_knot(last);
  }
}

}  // namespace topple::free_code
