/// Who will strike whom: the lines along which waves can run from the pushed bricks, known from the layout alone.
#pragma once

#include <cstdint>
#include <vector>

#include "topple/layout.h"

namespace topple::pivot {

/// Links of the bricks that a wave can reach; shape of every array: [brick_count].
struct Lines {
  std::vector<BrickId> ahead;       ///< First of the bricks that it strikes, kNoBrick if none.
  std::vector<BrickId> sibling;     ///< Next of the bricks struck by the same one.
  std::vector<BrickId> behind;      ///< The one that strikes it.
  std::vector<std::int32_t> depth;  ///< Bricks between it and the first of its line; greater further on. -1: out of reach.
  std::vector<std::int8_t> side;    ///< +1: it turns about its toe, -1: about its heel (struck from the front).
};

/// Follows every push. Refuses bricks above the floor, merges, crossings and loops, in words.
Result<Lines> find_lines(const Layout& layout);

}  // namespace topple::pivot
