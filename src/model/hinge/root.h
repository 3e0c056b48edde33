/// Zeros of functions of one number.
#pragma once

#include <cmath>

namespace topple::hinge {

/// Where f(x) = 0 between low and high, f(low) > 0 > f(high) or the other way round, by regula falsi with Illinois' halving.
template <typename Function>
double root(double low, double high, double at_low, double at_high, Function f) {
  double x = high;
  for (int round = 0; round < 50; ++round) {
    x = high - at_high * (high - low) / (at_high - at_low);
    const double at_x = f(x);
    if (std::fabs(at_x) < 1e-13) break;
    if ((at_x > 0.0) != (at_high > 0.0)) {
      low = high;
      at_low = at_high;
    } else {
      at_low *= 0.5;
    }
    high = x;
    at_high = at_x;
  }
  return x;
}

}  // namespace topple::hinge
