#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "recording/knot_code.h"

using namespace topple;

namespace {

float whole_steps(Random& random, double most, double step) {
  return static_cast<float>(rounded(most * (2.0 * random.uniform() - 1.0), step));
}

/// Knots of a brick that tumbles: multiples of their steps, times that never go back.
std::vector<FreeKnot> knots_of(Random& random, std::size_t count) {
  std::vector<FreeKnot> knots;
  double time = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto place = [&] { return whole_steps(random, 0.2, FreeSteps::kPlace); };
    const auto turn = [&] { return whole_steps(random, 1.0, FreeSteps::kTurn); };
    // From a crawl to a shot: numbers of no byte, of one, two and three.
    const double most = std::exp2(12.0 * random.uniform() - 10.0);
    const auto velocity = [&] { return whole_steps(random, most, FreeSteps::kVelocity); };
    const auto rate = [&] { return whole_steps(random, 30.0 * most, FreeSteps::kRate); };
    knots.push_back({.time = static_cast<float>(rounded(time, FreeSteps::kTime)),
                     .x = place(),
                     .y = place(),
                     .z = place(),
                     .qw = turn(),
                     .qx = turn(),
                     .qy = turn(),
                     .qz = turn(),
                     .vx = velocity(),
                     .vy = velocity(),
                     .vz = velocity(),
                     .wx = rate(),
                     .wy = rate(),
                     .wz = rate()});
    if (i % 5 != 4) time += 0.012 * random.uniform();
  }
  return knots;
}

std::vector<std::uint8_t> code_of(const std::vector<FreeKnot>& knots) {
  std::vector<std::uint8_t> code;
  encode(std::span<const FreeKnot>(knots), code);
  code.shrink_to_fit();  // What is read behind its end is seen by the address sanitizer.
  return code;
}

// Bit by bit: also what is not a number.
bool same(const FreeKnot& a, const FreeKnot& b) {
  using Words = std::array<std::uint32_t, sizeof(FreeKnot) / sizeof(std::uint32_t)>;
  return std::bit_cast<Words>(a) == std::bit_cast<Words>(b);
}

/// All of them come back to the last bit, and so does the last alone.
bool comes_back(const std::vector<FreeKnot>& knots) {
  const std::vector<std::uint8_t> code = code_of(knots);
  std::vector<HingedKnot> hinged;
  std::vector<FreeKnot> free;
  decode(code.data(), hinged, free);
  bool equal = hinged.empty() && free.size() == knots.size();
  for (std::size_t i = 0; equal && i < knots.size(); ++i) equal = same(knots[i], free[i]);
  const auto last = last_free_knot(code.data());
  return equal && last && same(*last, knots.back());
}

}  // namespace

TEST_CASE("knots that are multiples of their steps take less room than floats and come back to the last bit") {
  Random random(7);
  for (const std::size_t count : {1U, 2U, 3U, 17U, 240U}) {
    const std::vector<FreeKnot> knots = knots_of(random, count);
    CHECK(comes_back(knots));
    // 14 floats are 56 bytes; here numbers jump about as they never do in a motion.
    CHECK(code_of(knots).size() < 46 * count + 6);
  }
}

TEST_CASE("the code of a brick that stays in a plane has no bytes for what does not change") {
  std::vector<FreeKnot> knots(100);
  for (std::size_t i = 0; i < knots.size(); ++i) {
    knots[i].time = static_cast<float>(i) * 0x1p-7F;
    knots[i].wy = 1.0F;
  }
  // A word for the lengths, and three bytes for the time; the rate changes once.
  CHECK(code_of(knots).size() <= 7 * knots.size() + 10);
  CHECK(comes_back(knots));
}

TEST_CASE("knots that are no multiples, too large or no numbers at all come back as they were") {
  Random random(8);
  const std::vector<FreeKnot> good = knots_of(random, 5);
  const float infinite = std::numeric_limits<float>::infinity();
  for (const float bad : {0.1F, 1e-30F, 3.5F, 1e4F, 1e30F, -1e30F, infinite, -infinite, std::numeric_limits<float>::quiet_NaN()}) {
    for (std::size_t i = 0; i < good.size(); ++i) {
      for (const auto number : {&FreeKnot::time, &FreeKnot::x, &FreeKnot::qz, &FreeKnot::vx, &FreeKnot::vz, &FreeKnot::wx, &FreeKnot::wz}) {
        std::vector<FreeKnot> knots = good;
        knots[i].*number = bad;
        CHECK(comes_back(knots));
      }
    }
  }
}
