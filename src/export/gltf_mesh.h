/// What bricks look like in glTF: a box with rounded edges, or a ball.
#pragma once

#include <cstdint>
#include <vector>

#include "topple/layout.h"

namespace topple {

/// Places and normals of vertices, three numbers each, in the brick's own axes with y up; corners of triangles, counter-clockwise from
/// outside.
struct BrickMesh {
  std::vector<float> places;  ///< [m]
  std::vector<float> normals;
  std::vector<std::uint16_t> corners;
};

/// `bricks`: how many the layout has; the more, the fewer triangles each, as in the page: near 600, 100, or a plain box of 12.
BrickMesh brick_mesh(const BrickKind& kind, std::int64_t bricks);

}  // namespace topple
