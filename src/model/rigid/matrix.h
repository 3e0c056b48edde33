/// Three by three matrices, as little of them as six degrees of freedom need.
#pragma once

#include "topple/base.h"

namespace topple::rigid {

/// Rows of a matrix; of a rotation the columns are the brick's own axes in the world.
struct Mat3 {
  Vec3 r0, r1, r2;
};

constexpr Vec3 operator*(const Mat3& m, const Vec3& v) { return {dot(m.r0, v), dot(m.r1, v), dot(m.r2, v)}; }
constexpr Vec3 column(const Mat3& m, int axis) {
  return axis == 0 ? Vec3{m.r0.x, m.r1.x, m.r2.x} : axis == 1 ? Vec3{m.r0.y, m.r1.y, m.r2.y} : Vec3{m.r0.z, m.r1.z, m.r2.z};
}
/// The transpose times a vector: from the world to the brick's axes.
constexpr Vec3 transposed_times(const Mat3& m, const Vec3& v) {
  return {m.r0.x * v.x + m.r1.x * v.y + m.r2.x * v.z, m.r0.y * v.x + m.r1.y * v.y + m.r2.y * v.z,
          m.r0.z * v.x + m.r1.z * v.y + m.r2.z * v.z};
}
constexpr double component(const Vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

constexpr Mat3 rotation(const Quat& q) {
  const double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const double wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  return {{1.0 - 2.0 * (yy + zz), 2.0 * (xy - wz), 2.0 * (xz + wy)},
          {2.0 * (xy + wz), 1.0 - 2.0 * (xx + zz), 2.0 * (yz - wx)},
          {2.0 * (xz - wy), 2.0 * (yz + wx), 1.0 - 2.0 * (xx + yy)}};
}

/// R diag(d) R^T.
constexpr Mat3 conjugated(const Mat3& m, const Vec3& d) {
  const Vec3 a{m.r0.x * d.x, m.r0.y * d.y, m.r0.z * d.z};
  const Vec3 b{m.r1.x * d.x, m.r1.y * d.y, m.r1.z * d.z};
  const Vec3 c{m.r2.x * d.x, m.r2.y * d.y, m.r2.z * d.z};
  const double ab = dot(a, m.r1), ac = dot(a, m.r2), bc = dot(b, m.r2);
  return {{dot(a, m.r0), ab, ac}, {ab, dot(b, m.r1), bc}, {ac, bc, dot(c, m.r2)}};
}

}  // namespace topple::rigid
