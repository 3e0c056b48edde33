/// Where a function of one number is zero.
#pragma once

namespace topple::rigid {

/// Looks between 0 and `high`, at whose ends the function has the values `at_low` and `at_high` of opposite signs, by the secant that keeps
/// both signs (the Illinois rule). Ends after `most` values, or where `is_enough(value)`.
template <typename Function, typename Enough>
double zero_between(double high, double at_low, double at_high, int most, const Function& function, const Enough& is_enough) {
  const bool low_is_positive = at_low > 0.0;
  double low = 0.0, middle = high;
  for (int i = 0, side = 0; i < most; ++i) {
    middle = (low * at_high - high * at_low) / (at_high - at_low);
    const double value = function(middle);
    if (is_enough(value)) break;
    if ((value > 0.0) == low_is_positive) {
      low = middle;
      at_low = value;
      if (side == 1) at_high *= 0.5;
      side = 1;
    } else {
      high = middle;
      at_high = value;
      if (side == -1) at_low *= 0.5;
      side = -1;
    }
  }
  return middle;
}

}  // namespace topple::rigid
