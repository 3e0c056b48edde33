/// What a run was: arrival times, front speed, who fell, who did not.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "topple/recording.h"

namespace topple {

/// The wave along its trunk: the bricks from the first pushed one to the last that the wave reached, each struck by the one before.
struct Wave {
  std::vector<BrickId> bricks;
  std::vector<double> distance;  ///< Along the trunk, foot to foot [m].
  std::vector<double> arrival;   ///< When its tilt passed 10 degrees [s]; not a number if it did not.
  /// Between the bricks at 20 % and at 80 % of the trunk [m/s]; not a number if the wave is too short.
  double front_speed = std::numeric_limits<double>::quiet_NaN();

  /// Front speed near one brick of the trunk, over `window` bricks on either side [m/s].
  double local_speed(std::size_t index, std::size_t window = 1) const;
};
Wave measure_wave(const Recording& recording);

/// Who struck each brick first; kNoBrick for one that was pushed before, or that nobody struck.
std::vector<BrickId> first_strikers(const Recording& recording);

/// Whether each brick rests past its tip angle, leaning or flat.
std::vector<std::uint8_t> fallen_bricks(const Recording& recording);

struct RunSummary {
  std::int64_t bricks = 0;
  std::int64_t fallen = 0;                                        ///< Rest past their tip angle, leaning or flat.
  std::int64_t standing = 0;                                      ///< All others.
  double front_speed = std::numeric_limits<double>::quiet_NaN();  ///< [m/s]
  double duration = 0.0;                                          ///< Simulated [s].
};
RunSummary summarize(const Recording& recording);

/// Deepest overlap of any two neighbouring bricks at a moment, as a fraction of the thinner one's thickness; 0 if none overlap.
struct Overlap {
  double depth = 0.0;
  BrickId a = kNoBrick;
  BrickId b = kNoBrick;
};
Overlap deepest_overlap(const Recording& recording, double time);

}  // namespace topple
