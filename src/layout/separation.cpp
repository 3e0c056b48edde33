// Two oriented boxes, by the separating axis theorem.
#include <array>
#include <cmath>
#include <limits>

#include "topple/layout.h"

namespace topple {
namespace {

using Triple = std::array<double, 3>;
using Matrix = std::array<Triple, 3>;

/// The rotation of a unit quaternion, as rows.
Matrix matrix_of(const Quat& q) {
  const double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const double wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  return {{{1.0 - 2.0 * (yy + zz), 2.0 * (xy - wz), 2.0 * (xz + wy)},
           {2.0 * (xy + wz), 1.0 - 2.0 * (xx + zz), 2.0 * (yz - wx)},
           {2.0 * (xz - wy), 2.0 * (yz + wx), 1.0 - 2.0 * (xx + yy)}}};
}

/// The greatest gap along the six face normals. Column j of r is axis j of b, t is from a's centre to b's, all in the axes of a.
double face_gap(const Matrix& r, const Triple& t, const Triple& ha, const Triple& hb) {
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const double reach = ha[i] + hb[0] * std::abs(r[i][0]) + hb[1] * std::abs(r[i][1]) + hb[2] * std::abs(r[i][2]);
    const double gap = std::abs(t[i]) - reach;
    best = gap > best ? gap : best;
  }
  for (std::size_t j = 0; j < 3; ++j) {
    const double along = t[0] * r[0][j] + t[1] * r[1][j] + t[2] * r[2][j];
    const double reach = hb[j] + ha[0] * std::abs(r[0][j]) + ha[1] * std::abs(r[1][j]) + ha[2] * std::abs(r[2][j]);
    const double gap = std::abs(along) - reach;
    best = gap > best ? gap : best;
  }
  return best;
}

/// The gap along edge i of a crossed with edge j of b, at least `best`.
/// The axis is built from the entries of r, everything is projected on it as it is, and the result is divided by its length: so even for
/// edges that are almost parallel it is the gap of two boxes turned by no more than a rounding error.
double edge_gap(const Matrix& r, const Triple& t, const Triple& ha, const Triple& hb, std::size_t i, std::size_t j, double best) {
  constexpr double kParallel = 1e-30;  // squared sine of two edges that are parallel to the last digit: the face normals say it all
  const std::size_t u = (i + 1) % 3, v = (i + 2) % 3;
  const double bu = r[u][j], bv = r[v][j];  // the axis is -bv along u, bu along v
  const double length2 = bu * bu + bv * bv;
  if (length2 < kParallel) return best;
  const std::size_t k = (j + 1) % 3, l = (j + 2) % 3;
  const double reach = ha[u] * std::abs(bv) + ha[v] * std::abs(bu) + hb[k] * std::abs(bu * r[v][k] - bv * r[u][k]) +
                       hb[l] * std::abs(bu * r[v][l] - bv * r[u][l]);
  const double gap = (std::abs(bu * t[v] - bv * t[u]) - reach) / std::sqrt(length2);
  return gap > best ? gap : best;
}

/// The gap between a ball and a box: outside along the line to the nearest point, inside along the nearest face's normal.
double ball_gap(const Box& ball, const Box& box) {
  const Vec3 middle = rotate(conjugate(box.pose.orientation), ball.pose.position - box.pose.position);
  const Vec3 beyond{std::abs(middle.x) - box.half.x, std::abs(middle.y) - box.half.y, std::abs(middle.z) - box.half.z};
  const double inside = std::fmax(beyond.x, std::fmax(beyond.y, beyond.z));
  if (inside <= 0.0) return inside - ball.half.x;
  return norm({std::fmax(beyond.x, 0.0), std::fmax(beyond.y, 0.0), std::fmax(beyond.z, 0.0)}) - ball.half.x;
}

}  // namespace

double separation(const Box& a, const Box& b) {
  if (a.shape == Shape::ball && b.shape == Shape::ball) return norm(b.pose.position - a.pose.position) - a.half.x - b.half.x;
  if (a.shape == Shape::ball) return ball_gap(a, b);
  if (b.shape == Shape::ball) return ball_gap(b, a);
  // Everything in the axes of `a`: places far from the origin cost no digits beyond those of their difference.
  const Quat to_a = conjugate(a.pose.orientation);
  const Matrix r = matrix_of(to_a * b.pose.orientation);
  const Vec3 between = rotate(to_a, b.pose.position - a.pose.position);
  const Triple t{between.x, between.y, between.z};
  const Triple ha{a.half.x, a.half.y, a.half.z};
  const Triple hb{b.half.x, b.half.y, b.half.z};
  double best = face_gap(r, t, ha, hb);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) best = edge_gap(r, t, ha, hb, i, j, best);
  }
  return best;
}

}  // namespace topple
