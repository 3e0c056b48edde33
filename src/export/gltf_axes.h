/// From our axes (z up) to those of glTF (y up): x stays, y goes back. A program that puts z up again, as Blender does, then shows our
/// numbers.
#pragma once

#include <vector>

#include "topple/base.h"

namespace topple {

inline void add_y_up(const Vec3& v, std::vector<float>& out) {
  for (const double part : {v.x, v.z, -v.y}) out.push_back(static_cast<float>(part));
}

/// In the order x, y, z, w; also of the derivative of a quaternion.
inline void add_y_up(const Quat& q, std::vector<float>& out) {
  for (const double part : {q.x, q.z, -q.y, q.w}) out.push_back(static_cast<float>(part));
}

}  // namespace topple
