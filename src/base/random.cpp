#include "base/random.h"

#include <cmath>

#include "base/trigonometry.h"

namespace topple {

std::uint64_t Random::bits() {
  state_ += 0x9E3779B97F4A7C15ULL;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

double Random::uniform() {
  constexpr double kTwoToMinus52 = 1.0 / 4503599627370496.0;
  return (static_cast<double>(bits() >> 12) + 0.5) * kTwoToMinus52;
}

double Random::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2.0 * natural_log(uniform()));
  const SinCos turn = sin_cos(2.0 * kPi * uniform());
  spare_ = radius * turn.sin;
  has_spare_ = true;
  return radius * turn.cos;
}

}  // namespace topple
