/// Elementary functions that give the same bits on every machine. The C libraries of a desktop and of a browser agree on sqrt alone,
/// so whatever decides where a brick is uses these. Accurate to about 1e-16 relative, for finite arguments.
#pragma once

#include <bit>
#include <cstdint>

namespace topple {

inline constexpr double kPi = 3.14159265358979323846;

struct SinCos {
  double sin = 0.0;
  double cos = 1.0;
};

/// Both at once; |x| up to 1e6 [rad]. Here, since it is the innermost part of every fall: inlined it costs some 35 instructions.
inline SinCos sin_cos(double x) {
  // pi/2 in three pieces; the first two have 33 bits, so that products with a quadrant number below 2^20 are exact.
  constexpr double kHalfPi1 = 0x1.921fb544p+0;
  constexpr double kHalfPi2 = 0x1.0b4611a6p-34;
  constexpr double kHalfPi3 = 0x1.3198a2e037073p-69;
  const double scaled = x * (2.0 / kPi) + 0.5;
  auto quadrant = static_cast<std::int64_t>(scaled);
  if (static_cast<double>(quadrant) > scaled) --quadrant;  // The floor of it.
  const auto quadrants = static_cast<double>(quadrant);
  const double r = ((x - quadrants * kHalfPi1) - quadrants * kHalfPi2) - quadrants * kHalfPi3;
  // Both Taylor series side by side, the sine's first: on [-pi/4, pi/4] the first terms left out are below 1e-19.
  using Two = double __attribute__((vector_size(16)));
  const double q = r * r;
  const Two square = {q, q};
  Two series = {1.0 / 355687428096000.0, 0.0};
  series = series * square + Two{-1.0 / 1307674368000.0, 1.0 / 20922789888000.0};
  series = series * square + Two{1.0 / 6227020800.0, -1.0 / 87178291200.0};
  series = series * square + Two{-1.0 / 39916800.0, 1.0 / 479001600.0};
  series = series * square + Two{1.0 / 362880.0, -1.0 / 3628800.0};
  series = series * square + Two{-1.0 / 5040.0, 1.0 / 40320.0};
  series = series * square + Two{1.0 / 120.0, -1.0 / 720.0};
  series = series * square + Two{-1.0 / 6.0, 1.0 / 24.0};
  const double s = r + r * (q * series[0]);
  const double c = (1.0 - 0.5 * q) + q * (q * series[1]);
  // Quadrant 1 has (c, -s) for (sin, cos) of the remainder's (s, c), 2 has (-s, -c), 3 has (-c, s).
  const bool odd = (quadrant & 1) != 0;
  const auto flip = [](double value, std::int64_t minus) {
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^ (static_cast<std::uint64_t>(minus) << 62 & 0x8000000000000000ULL));
  };
  return {flip(odd ? c : s, quadrant), flip(odd ? s : c, quadrant + 1)};
}

double arc_tangent(double y, double x);  ///< In (-pi, pi] [rad].
double arc_sine(double x);               ///< x in [-1, 1]; in [-pi/2, pi/2] [rad].
double arc_cosine(double x);             ///< x in [-1, 1]; in [0, pi] [rad].
double natural_log(double x);            ///< x > 0 and normal.

}  // namespace topple
