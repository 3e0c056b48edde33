/// Who struck whom, and when the wave came, brick by brick.
#pragma once

#include <vector>

#include "topple/recording.h"

namespace topple {

/// A pushed brick is a beginning, whoever strikes it later.
struct Strikes {
  static constexpr BrickId kUnknown = -2;

  std::vector<BrickId> by;  ///< Who struck each brick first; kNoBrick where it was pushed or fell by itself, kUnknown where nothing came.
  std::vector<double> arrival;  ///< When the wave reached each brick; not a number where it did not [s].
  BrickId last = kNoBrick;      ///< The last brick that the wave reached.
};

Strikes strikes_of(const Recording& recording);

}  // namespace topple
