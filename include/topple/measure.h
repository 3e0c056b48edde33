/// What a run was: arrival times, front speed, who fell, who did not.
#pragma once

#include <cstddef>
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

/// How the wave went through one part of the layout.
struct PartTimes {
  std::size_t part = 0;      ///< Index into Layout::parts.
  std::int64_t fallen = 0;   ///< Bricks that rest past their tip angle.
  std::int64_t reached = 0;  ///< Bricks whose tilt passed 10 degrees; of a part with none all that follows is unknown.
  BrickId first = kNoBrick;  ///< The brick that passed 10 degrees first.
  BrickId last = kNoBrick;   ///< The one that did last.
  double first_arrival = std::numeric_limits<double>::quiet_NaN();  ///< [s]
  double last_arrival = std::numeric_limits<double>::quiet_NaN();   ///< [s]
  double brick_rate = std::numeric_limits<double>::quiet_NaN();     ///< From the first to the last; not a number if there is but one [1/s].
  /// From the first to the last along the part, foot to foot; not a number where a part is no line [m/s].
  double speed = std::numeric_limits<double>::quiet_NaN();
  BrickId from = kNoBrick;  ///< The brick of another part that brought the wave; none where a push or anything else began it.
  double pushed_at = std::numeric_limits<double>::quiet_NaN();  ///< When the push was that began it; not a number if none did [s].
  /// Counted from 0. Parts with the same number started together: one brick struck them all (a split), or they were pushed at one moment.
  std::int64_t start = -1;
};
/// The time sheet: every part, in the order in which the wave came; those that start together follow each other, those that nothing
/// reached are last.
std::vector<PartTimes> measure_parts(const Recording& recording);

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
