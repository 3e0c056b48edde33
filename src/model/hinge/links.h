/// Which brick each brick will fall on, and what the chain of hinges cannot follow.
#pragma once

#include <vector>

#include "topple/layout.h"

namespace topple::hinge {

/// The brick ahead that a brick reaches when it falls.
struct Link {
  double pitch = 0.0;       ///< Toe to toe along the mean of their headings [m].
  BrickId next = kNoBrick;  ///< None if it falls flat.
};

/// How far neighbours may be turned against each other [rad]: 5 degrees. Their distances along the row are then right within
/// 1 - cos(5 deg) = 0.4 %, their corners within width / 2 x sin(5 deg), 1 mm of a 24 mm wide brick.
inline constexpr double kLargestTurn = 0.08726646259971647;
/// How far the brick ahead may stand to one side, as a fraction of the narrower one's width: further, and the hit would twist it.
inline constexpr double kLargestOffset = 0.25;
/// The least gap, as a fraction of the height: bricks that touch move as one block, not as a chain.
inline constexpr double kLeastGap = 0.005;

/// One link a brick; or why this layout is beyond the chain, a line each problem (at most ten), naming the model that can.
Result<std::vector<Link>> find_links(const Layout& layout);

}  // namespace topple::hinge
