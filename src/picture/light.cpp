#include "picture/light.h"

#include <array>
#include <bit>
#include <cstdint>

namespace topple {
namespace {

/// x^2.4, for x from 0 to 1: the fifth root by Newton's method from above, to the last bit or two.
constexpr double power_2_4(double x) {
  double root = 1.0;
  for (int i = 0; i < 60; ++i) root -= (root - x / (root * root * root * root)) / 5.0;
  return x * x * root * root;
}

/// sRGB's curve (IEC 61966-2-1), at compile time: the C libraries of a desktop and of a browser need not agree on pow.
constexpr std::array<double, 256> kLinear = [] {
  std::array<double, 256> light{};
  for (std::size_t i = 0; i < light.size(); ++i) {
    const double share = static_cast<double>(i) / 255.0;
    light[i] = share <= 0.04045 ? share / 12.92 : power_2_4((share + 0.055) / 1.055);
  }
  return light;
}();

/// For x from -100 to 100: a third of the exponent is a guess to 5 %, four steps of Newton's method leave 1e-14.
double cube_root(double x) {
  if (x < 0.0) return -cube_root(-x);
  if (x < 1e-30) return 0.0;
  double root = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) / 3 + (std::uint64_t{0x2A9F7893} << 32U));
  for (int i = 0; i < 4; ++i) root -= (root - x / (root * root)) / 3.0;
  return root;
}

}  // namespace

Light light_of(const Color& color) { return {kLinear[color.red], kLinear[color.green], kLinear[color.blue]}; }

// [Ottosson2020]: both matrices as printed there.
Seen seen(const Light& light) {
  const double l = cube_root(0.4122214708 * light.red + 0.5363325363 * light.green + 0.0514459929 * light.blue);
  const double m = cube_root(0.2119034982 * light.red + 0.6806995451 * light.green + 0.1073969566 * light.blue);
  const double s = cube_root(0.0883024619 * light.red + 0.2817188376 * light.green + 0.6299787005 * light.blue);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s, 1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

double squared_distance(const Seen& a, const Seen& b) {
  const double l = a.lightness - b.lightness, r = a.green_red - b.green_red, y = a.blue_yellow - b.blue_yellow;
  return l * l + r * r + y * y;
}

}  // namespace topple
