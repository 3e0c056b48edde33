/// No brick in mid-air.
#pragma once

#include <vector>

#include "layout/parts.h"
#include "layout/problems.h"
#include "topple/layout.h"

namespace topple {

/// The bricks above the floor whose foot touches the top of no other, ascending; no more than `most` of them.
std::vector<BrickId> find_unsupported(const Layout& layout, std::size_t most);

/// Each as a problem at its part. `plans` made the bricks in the order of their numbers.
void report_unsupported(const Layout& layout, const std::vector<PartPlan>& plans, Problems& problems);

}  // namespace topple
