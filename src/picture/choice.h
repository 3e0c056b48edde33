/// Which brick gets which colour.
#pragma once

#include <cstdint>
#include <vector>

#include "picture/light.h"
#include "topple/picture.h"

namespace topple {

/// A colour's number for each cell, and how many of each there are. The stock must be enough for all.
void choose_colors(const std::vector<Light>& cells, bool dither, Picture& picture);

}  // namespace topple
