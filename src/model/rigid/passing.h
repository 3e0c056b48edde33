/// Impacts that neither end of a drift shows.
#pragma once

#include <algorithm>

namespace topple::rigid {

/// When the first new point touches in a drift of `whole` [s]; `whole` if none does. `try_drift(time)` finds the points after `time` of it,
/// `first_impact(time)` the first impact of those, or `time`. Two bricks that are apart before the drift and after it may have gone through
/// each other in between, where they have passed by more than half a thickness; `passing()` is by how many they have at most, of those that
/// may have met, in the drift that was tried. Then it is looked at in parts.
template <class TryDrift, class Passing, class FirstImpact>
double cut_of(double whole, TryDrift try_drift, Passing passing, FirstImpact first_impact) {
  constexpr double kUnseen = 0.5, kMostParts = 31.0;
  try_drift(whole);
  const int parts = 1 + static_cast<int>(std::min(passing() / kUnseen, kMostParts));
  for (int part = 1; part < parts; ++part) {
    const double time = whole * part / parts;
    try_drift(time);
    const double cut = first_impact(time);
    if (cut < time) return cut;
  }
  if (parts > 1) try_drift(whole);
  return first_impact(whole);
}

}  // namespace topple::rigid
