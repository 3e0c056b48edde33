/// `key=value` from the command line, put into the tree before it is understood.
#pragma once

#include <span>
#include <string>

#include "layout/problems.h"

namespace topple {

void apply_overrides(Node& root, std::span<const std::string> overrides, Problems& problems);

}  // namespace topple
