/// An image cut into cells.
#pragma once

#include <vector>

#include "picture/light.h"
#include "topple/picture.h"

namespace topple {

/// The mean light of each cell, line by line; pixels that lie across an edge are shared by area.
std::vector<Light> mean_light(const Image& image, const PictureSize& size);

}  // namespace topple
