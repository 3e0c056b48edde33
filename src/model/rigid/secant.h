/// Where a function of one number is zero, and when a distance is.
#pragma once

namespace topple::rigid {

/// Looks between `low` and `high`, at whose ends the function has the values `at_low` and `at_high` of opposite signs, by the secant that
/// keeps both signs (the Illinois rule). Ends after `most` values, or where `is_enough(value)`.
template <typename Function, typename Enough>
double zero_between(double low, double high, double at_low, double at_high, int most, const Function& function, const Enough& is_enough) {
  const bool low_is_positive = at_low > 0.0;
  double middle = high;
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

/// When a point begins to touch in a drift of `time`, at whose end its distance is `at_end` < 0. `distance` is that of a moment, huge where
/// there is no such point; less than `near` is touching. One that touches at the beginning without taking part has just parted, and comes
/// back within the drift, or never gets clear: then the answer is 0.
template <typename Function, typename Enough>
double impact_between(double time, double near, double at_end, const Function& distance, const Enough& is_enough) {
  constexpr double kNone = 1e200;
  const auto located = [&](double value) { return is_enough(value) || !(value < kNone); };
  double clear = 0.0, at_clear = distance(0.0);
  if (at_clear > near && at_clear < kNone) return zero_between(0.0, time, at_clear, at_end, 30, distance, located);
  double touching = time, at_touching = at_end;
  for (const double share : {0.0625, 0.125, 0.25, 0.5}) {
    const double moment = share * time, value = distance(moment);
    if (value > near) {
      clear = moment;
      at_clear = value;
    } else if (at_clear > near) {
      touching = moment;
      at_touching = value;
      break;
    }
  }
  if (at_clear <= near) return 0.0;
  if (at_clear < kNone) return at_touching < 0.0 ? zero_between(clear, touching, at_clear, at_touching, 30, distance, located) : touching;
  // It appears between the two: a face takes over from an edge.
  for (int i = 0; i < 10; ++i) {
    const double middle = 0.5 * (clear + touching);
    (distance(middle) > near ? clear : touching) = middle;
  }
  return touching;
}

}  // namespace topple::rigid
