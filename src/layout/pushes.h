/// [[push]]: read before there are bricks, checked against them afterwards.
#pragma once

#include <vector>

#include "layout/section.h"
#include "topple/layout.h"

namespace topple {

struct PushPlan {
  Push push;
  Place brick_place, height_place;
  std::string path;  ///< "push.0"
};

std::vector<PushPlan> read_pushes(const Section& top, Problems& problems);

/// The pushes of a layout with bricks: a push on a brick that is not there, or above its top, is a problem.
std::vector<Push> place_pushes(const std::vector<PushPlan>& plans, const Layout& layout, Problems& problems);

}  // namespace topple
