#include "recording/knot_code.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "recording/free_code.h"

namespace topple {
namespace {

enum class Way : std::uint8_t { rounded, floats, free, free_rounded };

/// A knot in steps; less than 2^24 of each.
struct Whole {
  std::int32_t time = 0, angle = 0, rate = 0, acceleration = 0;
};

// A float has each multiple of a step, a power of two, up to 2^24 of them, and so has its product with one over the step.
inline bool to_steps(float value, double step, std::int32_t& steps) {
  const float exact = value * static_cast<float>(1.0 / step);
  if (!(std::abs(exact) < 0x1p24F)) return false;
  steps = static_cast<std::int32_t>(exact);
  return static_cast<float>(steps) == exact;
}

inline bool to_whole(const HingedKnot& knot, Whole& whole) {
  return to_steps(knot.time, KnotSteps::kTime, whole.time) && to_steps(knot.angle, KnotSteps::kAngle, whole.angle) &&
         to_steps(knot.rate, KnotSteps::kRate, whole.rate) && to_steps(knot.acceleration, KnotSteps::kAcceleration, whole.acceleration);
}

// What a rate is after an even change of acceleration; after a jump most are zero. Any guess will do that the decoder makes too, so these
// are computed in whole numbers or in the plainest of doubles.
inline std::int32_t expected_rate(const Whole& last, const Whole& now) {
  if (now.time == last.time) return 0;
  const double span = (now.time - last.time) * KnotSteps::kTime;
  const double mean = 0.5 * KnotSteps::kAcceleration * (1.0 * last.acceleration + now.acceleration);
  const double change = mean * span / KnotSteps::kRate;
  return std::abs(change) < 0x1p24 ? static_cast<std::int32_t>(last.rate + change) : last.rate;
}

// The angle that the corrected trapezium rule expects.
inline std::int32_t expected_angle(const Whole& last, const Whole& now) {
  if (now.time == last.time) return last.angle;
  const double span = (now.time - last.time) * KnotSteps::kTime;
  const double mean = 0.5 * KnotSteps::kRate * (1.0 * last.rate + now.rate);
  const double bend = (KnotSteps::kAcceleration / 12.0) * (1.0 * last.acceleration - now.acceleration);
  const double change = span * (mean + span * bend) / KnotSteps::kAngle;
  return std::abs(change) < 0x1p24 ? static_cast<std::int32_t>(last.angle + change) : last.angle;
}

HingedKnot to_knot(const Whole& whole) {
  return {static_cast<float>(whole.time * KnotSteps::kTime), static_cast<float>(whole.angle * KnotSteps::kAngle),
          static_cast<float>(whole.rate * KnotSteps::kRate), static_cast<float>(whole.acceleration * KnotSteps::kAcceleration)};
}

// Seven bits a byte, the lowest first; the eighth says that more follow. The sign is the lowest bit.
constexpr std::size_t kMostBytes = 5;  // Of a number.
inline void put(std::uint8_t*& out, std::uint32_t value) {
  // Up to four bytes at once: how many differs from number to number, and a loop would be guessed wrong.
  if (value < (1U << 28)) {
    const std::uint32_t spread = (value & 0x7FU) | ((value & 0x3F80U) << 1) | ((value & 0x1FC000U) << 2) | ((value & 0xFE00000U) << 3);
    const auto more = (static_cast<unsigned>(std::bit_width(value | 1U)) - 1) / 7;
    const std::uint32_t word = spread | (0x80808080U & ((1U << (8 * more)) - 1));
    std::memcpy(out, &word, sizeof word);
    out += more + 1;
    return;
  }
  while (value >= 128) {
    *out++ = static_cast<std::uint8_t>(value | 128U);
    value >>= 7;
  }
  *out++ = static_cast<std::uint8_t>(value);
}
inline void put_signed(std::uint8_t*& out, std::int32_t value) {
  put(out, (static_cast<std::uint32_t>(value) << 1) ^ static_cast<std::uint32_t>(value >> 31));
}

inline std::uint32_t get(const std::uint8_t*& code) {
  std::uint32_t value = 0;
  for (unsigned shift = 0;; shift += 7) {
    const std::uint8_t byte = *code++;
    value |= (byte & 127U) << shift;
    if (byte < 128) return value;
  }
}
inline std::int32_t get_signed(const std::uint8_t*& code) {
  const std::uint32_t value = get(code);
  return static_cast<std::int32_t>(value >> 1) ^ -static_cast<std::int32_t>(value & 1U);
}

constexpr std::size_t kHead = kMostBytes + 1;

// A rounded hinged track has its last knot behind the head, as it is, and then the codes of all.
void put_last(std::uint8_t*& out, const HingedKnot& last) {
  std::memcpy(out, &last, sizeof last);
  out += sizeof last;
}

inline void head(std::uint8_t*& out, std::size_t count, Way way) {
  put(out, static_cast<std::uint32_t>(count));
  *out++ = static_cast<std::uint8_t>(way);
}

template <typename Knot>
void put_floats(std::span<const Knot> knots, Way way, std::vector<std::uint8_t>& out) {
  const std::size_t start = out.size();
  out.resize(start + kHead + knots.size_bytes());
  std::uint8_t* next = out.data() + start;
  head(next, knots.size(), way);
  std::memcpy(next, knots.data(), knots.size_bytes());
  out.resize(static_cast<std::size_t>(next - out.data()) + knots.size_bytes());
}

}  // namespace

void encode(std::span<const HingedKnot> knots, std::vector<std::uint8_t>& out) {
  const std::size_t start = out.size();
  out.resize(start + kHead + sizeof(HingedKnot) + 4 * kMostBytes * knots.size());
  std::uint8_t* next = out.data() + start;
  head(next, knots.size(), Way::rounded);
  put_last(next, knots.back());
  Whole last;
  for (const HingedKnot& knot : knots) {
    Whole now;
    if (!to_whole(knot, now) || now.time < last.time) {
      out.resize(start);
      return put_floats(knots, Way::floats, out);
    }
    put(next, static_cast<std::uint32_t>(now.time - last.time));
    put_signed(next, now.acceleration - last.acceleration);
    put_signed(next, now.rate - expected_rate(last, now));
    put_signed(next, now.angle - expected_angle(last, now));
    last = now;
  }
  out.resize(static_cast<std::size_t>(next - out.data()));
}

void encode(std::span<const FreeKnot> knots, std::vector<std::uint8_t>& out) {
  const std::size_t start = out.size();
  out.resize(start + kHead + free_code::kMostBytes * knots.size());
  std::uint8_t* next = out.data() + start;
  head(next, knots.size(), Way::free_rounded);
  if (!free_code::put(knots, next)) {
    out.resize(start);
    return put_floats(knots, Way::free, out);
  }
  out.resize(static_cast<std::size_t>(next - out.data()));
}

std::optional<HingedKnot> last_hinged_knot(const std::uint8_t* code) {
  const std::size_t count = get(code);
  const auto way = static_cast<Way>(*code++);
  if (way == Way::free || way == Way::free_rounded) return std::nullopt;
  HingedKnot last;
  std::memcpy(&last, way == Way::floats ? code + (count - 1) * sizeof last : code, sizeof last);
  return last;
}

std::optional<FreeKnot> last_free_knot(const std::uint8_t* code) {
  const std::size_t count = get(code);
  const auto way = static_cast<Way>(*code++);
  if (way == Way::free) {
    FreeKnot last;
    std::memcpy(&last, code + (count - 1) * sizeof last, sizeof last);
    return last;
  }
  if (way != Way::free_rounded) return std::nullopt;
  return free_code::get_last(code);
}

void decode(const std::uint8_t* code, std::vector<HingedKnot>& hinged, std::vector<FreeKnot>& free) {
  const std::size_t count = get(code);
  const auto way = static_cast<Way>(*code++);
  const std::size_t before = way == Way::free || way == Way::free_rounded ? free.size() : hinged.size();
  if (way == Way::free) {
    free.resize(before + count);
    std::memcpy(free.data() + before, code, count * sizeof(FreeKnot));
    return;
  }
  if (way == Way::free_rounded) {
    free.resize(before + count);
    free_code::get(code, std::span(free).subspan(before));
    return;
  }
  hinged.resize(before + count);
  if (way == Way::floats) {
    std::memcpy(hinged.data() + before, code, count * sizeof(HingedKnot));
    return;
  }
  code += sizeof(HingedKnot);
  Whole whole;
  for (HingedKnot& knot : std::span(hinged).subspan(before)) {
    const Whole last = whole;
    whole.time += static_cast<std::int32_t>(get(code));
    whole.acceleration += get_signed(code);
    whole.rate = expected_rate(last, whole) + get_signed(code);
    whole.angle = expected_angle(last, whole) + get_signed(code);
    knot = to_knot(whole);
  }
}

}  // namespace topple
