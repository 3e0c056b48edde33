#include "base/trigonometry.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace topple {

namespace {

// |x| <= 1/16, so eight terms leave less than 1e-19.
double atan_series(double x) {
  const double q = x * x;
  double a = -1.0 / 15.0;
  a = a * q + 1.0 / 13.0;
  a = a * q - 1.0 / 11.0;
  a = a * q + 1.0 / 9.0;
  a = a * q - 1.0 / 7.0;
  a = a * q + 1.0 / 5.0;
  a = a * q - 1.0 / 3.0;
  return x + x * (q * a);
}

// atan(i / 8), to which the series adds the rest.
constexpr std::array<double, 9> kAtanOfEighths = {0.0,
                                                  0.12435499454676144,
                                                  0.24497866312686414,
                                                  0.35877067027057225,
                                                  0.4636476090008061,
                                                  0.5585993153435624,
                                                  0.6435011087932844,
                                                  0.7188299996216245,
                                                  0.7853981633974483};

// 0 <= x <= 1; atan(x) = atan(c) + atan((x - c) / (1 + c x)).
double atan_unit(double x) {
  const auto eighth = static_cast<std::int32_t>(8.0 * x + 0.5);
  const double c = eighth / 8.0;
  return kAtanOfEighths[static_cast<std::size_t>(eighth)] + atan_series((x - c) / (1.0 + c * x));
}

}  // namespace

double arc_tangent(double y, double x) {
  const double ay = std::fabs(y);
  const double ax = std::fabs(x);
  if (ay == 0.0 && ax == 0.0) return 0.0;
  double angle = ay <= ax ? atan_unit(ay / ax) : 0.5 * kPi - atan_unit(ax / ay);
  if (x < 0.0) angle = kPi - angle;
  return y < 0.0 ? -angle : angle;
}

double arc_sine(double x) { return arc_tangent(x, std::sqrt((1.0 - x) * (1.0 + x))); }

double arc_cosine(double x) { return arc_tangent(std::sqrt((1.0 - x) * (1.0 + x)), x); }

double natural_log(double x) {
  // x = m 2^k with m in [sqrt(1/2), sqrt(2)); log m = 2 artanh((m - 1) / (m + 1)).
  const auto word = std::bit_cast<std::uint64_t>(x);
  int exponent = static_cast<int>(word >> 52) - 1023;
  double m = std::bit_cast<double>((word & 0x000FFFFFFFFFFFFFULL) | 0x3FF0000000000000ULL);
  if (m > 1.4142135623730951) {
    m *= 0.5;
    exponent += 1;
  }
  const double s = (m - 1.0) / (m + 1.0);
  const double q = s * s;
  double series = 1.0 / 21.0;
  for (const double n : {19.0, 17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0, 3.0}) series = series * q + 1.0 / n;
  constexpr double kLn2High = 0x1.62e42feep-1;  // 32 bits, so that its product with an exponent is exact.
  constexpr double kLn2Low = 0x1.a39ef35793c76p-33;
  const double k = exponent;
  return k * kLn2High + (2.0 * s + (2.0 * s * q * series + k * kLn2Low));
}

}  // namespace topple
