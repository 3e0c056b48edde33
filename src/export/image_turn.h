/// Photographs are stored as the camera was held, and say so.
#pragma once

#include <string_view>

#include "topple/picture.h"

namespace topple {

/// What the Exif part of a JPEG file says (its tag 0x0112), 1 to 8; 1, as it is stored, where it says nothing that can be read.
int orientation_of(std::string_view jpeg);

/// The image as it is to be seen.
Image turned(const Image& image, int orientation);

}  // namespace topple
