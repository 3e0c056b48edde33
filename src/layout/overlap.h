/// No two bricks in one place.
#pragma once

#include <vector>

#include "layout/parts.h"
#include "layout/problems.h"
#include "topple/layout.h"

namespace topple {

struct OverlappingPair {
  BrickId first = 0;
  BrickId second = 0;
  double depth = 0.0;  ///< [m]
};

/// The pairs of bricks that overlap by more than a thousandth of the thinner one's thickness, in the order of their numbers;
/// no more than `most` of them.
std::vector<OverlappingPair> find_overlaps(const Layout& layout, std::size_t most);

/// Each as a problem at the part of its second brick. `plans` are those of layout.parts.
void report_overlaps(const Layout& layout, const std::vector<PartPlan>& plans, Problems& problems);

}  // namespace topple
