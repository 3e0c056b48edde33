#include "base/trigonometry.h"

#include <doctest/doctest.h>

#include <cmath>

#include "base/hash.h"
#include "base/random.h"

namespace topple {
namespace {

// The C library of the test machine is correct to about one unit in the last place, at most 2.2e-16 relative; ours may be off by two more.
constexpr double kTolerance = 6.7e-16;

double error(double ours, double theirs) { return std::fabs(ours - theirs) / std::fmax(std::fabs(theirs), 1e-3); }

TEST_CASE("sine_and_cosine_agree_with_the_c_library") {
  for (int i = -200000; i <= 200000; ++i) {
    const double x = 0.000731 * i;
    const SinCos ours = sin_cos(x);
    REQUIRE(error(ours.sin, std::sin(x)) < kTolerance);
    REQUIRE(error(ours.cos, std::cos(x)) < kTolerance);
  }
}

TEST_CASE("sine_and_cosine_of_a_fall_agree_with_the_c_library") {
  for (int i = -2000; i <= 20000; ++i) {
    const double x = 0.0001 * i;
    const SinCos ours = sin_cos_of_fall(x);
    // Absolute: near a right angle the cosine is what is left of a difference. The roundings of three terms, each of at most 1.1e-16.
    REQUIRE(std::fabs(ours.sin - std::sin(x)) < 3.4e-16);
    REQUIRE(std::fabs(ours.cos - std::cos(x)) < 3.4e-16);
  }
}

TEST_CASE("arc_functions_agree_with_the_c_library_in_every_quadrant") {
  for (int i = 0; i < 100000; ++i) {
    const double angle = -3.14 + 6.28 * i / 100000;
    const double y = 0.7 * std::sin(angle);
    const double x = 0.7 * std::cos(angle);
    REQUIRE(error(arc_tangent(y, x), std::atan2(y, x)) < kTolerance);
    const double ratio = -1.0 + 2.0 * i / 99999;
    REQUIRE(std::fabs(arc_sine(ratio) - std::asin(ratio)) < 1e-15);
    REQUIRE(std::fabs(arc_cosine(ratio) - std::acos(ratio)) < 1e-15);
  }
  CHECK(arc_tangent(0.0, -1.0) == kPi);
  CHECK(arc_tangent(0.0, 0.0) == 0.0);
}

TEST_CASE("the_natural_log_agrees_with_the_c_library") {
  for (int i = 1; i < 100000; ++i) {
    const double x = 1e-9 * i * i * i;
    REQUIRE(std::fabs(natural_log(x) - std::log(x)) < 1e-15 * std::fmax(1.0, std::fabs(std::log(x))));
  }
}

TEST_CASE("normal_numbers_have_mean_zero_and_deviation_one") {
  Random random(1);
  constexpr int kCount = 200000;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.normal();
    sum += x;
    squares += x * x;
  }
  // Standard errors: 1 / sqrt(n) of the mean, sqrt(2 / n) of the variance; five of them.
  CHECK(std::fabs(sum / kCount) < 5.0 / std::sqrt(kCount));
  CHECK(std::fabs(squares / kCount - 1.0) < 5.0 * std::sqrt(2.0 / kCount));
}

TEST_CASE("random_numbers_are_the_same_on_every_machine") {
  Random random(42);
  Hash hash;
  for (int i = 0; i < 1000; ++i) hash.add(random.normal());
  CHECK(hash.value() == 8522655165720418258ULL);
}

TEST_CASE("the_hash_sees_the_last_bit_and_the_order") {
  Hash a;
  Hash b;
  Hash c;
  a.add(1.0);
  a.add(2.0);
  b.add(1.0);
  b.add(std::nextafter(2.0, 3.0));
  c.add(2.0);
  c.add(1.0);
  CHECK(a.value() != b.value());
  CHECK(a.value() != c.value());
}

}  // namespace
}  // namespace topple
