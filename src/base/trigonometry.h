/// Elementary functions that give the same bits on every machine. The C libraries of a desktop and of a browser agree on sqrt alone,
/// so whatever decides where a brick is uses these. Accurate to about 1e-16 relative, for finite arguments.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
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

/// Sine and cosine of i / 16, of angles up to a little over pi/2.
inline constexpr std::array<SinCos, 27> kSixteenths = {{
    {0.0, 1.0},
    {0.0624593178423802, 0.9980475107000991},
    {0.12467473338522769, 0.992197667229329},
    {0.18640329676226988, 0.9824733131012553},
    {0.24740395925452294, 0.9689124217106447},
    {0.30743851458038085, 0.9515679480481722},
    {0.36627252908604757, 0.9305076219123143},
    {0.42367625720393803, 0.9058136834259364},
    {0.479425538604203, 0.8775825618903728},
    {0.5333026735360201, 0.8459244992310679},
    {0.5850972729404622, 0.8109631195052179},
    {0.6346070800152693, 0.7728349461524715},
    {0.6816387600233341, 0.7316888688738209},
    {0.7260086552607126, 0.6876855622205048},
    {0.7675435022360271, 0.6409968581633251},
    {0.806081108260693, 0.5918050750924775},
    {0.8414709848078965, 0.5403023058681398},
    {0.8735749351670711, 0.4866896677019633},
    {0.9022675940990952, 0.4311765167986662},
    {0.9274369173848677, 0.37397963082453317},
    {0.9489846193555862, 0.3153223623952687},
    {0.9668265566961802, 0.2554337668888117},
    {0.9808930570231557, 0.19454770798898718},
    {0.9911291909537616, 0.13290194445282522},
    {0.9974949866040544, 0.0707372016677029},
    {0.9999655856782489, 0.008296231623858378},
    {0.9985313405398316, -0.05417713502693632},
}};

/// As sin_cos(), in half the time for the tilts of a fall, 0 to pi/2 [rad]: both are right to 3e-16, but a cosine near 0 is not to more.
inline SinCos sin_cos_of_fall(double x) {
  if (!(x >= 0.0 && x < 1.6)) return sin_cos(x);
  // The nearest sixteenth, and of what is left, up to 1/32, both Taylor series: the first terms left out are below 1e-17 and 1e-19.
  const auto sixteenth = static_cast<std::int32_t>(16.0 * x + 0.5);
  const SinCos& whole = kSixteenths[static_cast<std::size_t>(sixteenth)];
  const double r = x - sixteenth / 16.0;
  const double q = r * r;
  const double s = r - r * q * (1.0 / 6.0 - q * (1.0 / 120.0 - q * (1.0 / 5040.0)));
  const double c = q * (0.5 - q * (1.0 / 24.0 - q * (1.0 / 720.0 - q * (1.0 / 40320.0))));  // One minus the cosine.
  return {whole.sin + (whole.cos * s - whole.sin * c), whole.cos - (whole.sin * s + whole.cos * c)};
}

double arc_tangent(double y, double x);  ///< In (-pi, pi] [rad].
double arc_sine(double x);               ///< x in [-1, 1]; in [-pi/2, pi/2] [rad].
double arc_cosine(double x);             ///< x in [-1, 1]; in [0, pi] [rad].
double natural_log(double x);            ///< x > 0 and normal.

}  // namespace topple
