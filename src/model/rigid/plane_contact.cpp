#include "model/rigid/plane_contact.h"

#include <algorithm>
#include <cmath>

#include "base/trigonometry.h"

namespace topple::rigid {

namespace {

struct Corner {
  double x, z;
  std::uint8_t feature;
};

Corner corner_of(const PlaneBox& box, unsigned which) {
  const double along = (which & 1U) != 0 ? box.half_along : -box.half_along;
  const double up = (which & 2U) != 0 ? box.half_up : -box.half_up;
  return {box.place.x + along * box.cosine + up * box.sine, box.place.z - along * box.sine + up * box.cosine,
          static_cast<std::uint8_t>(which)};
}

// A side of a box: its middle against the centre of another box, and from there to its far end.
struct Side {
  double x, z;
  double to_x, to_z;
  std::uint8_t near_end, far_end;
};

// The side of `box` that looks most against a normal (x, z).
Side side_against(const PlaneBox& box, const PlaneBox& base, double x, double z) {
  const double u = x * box.cosine - z * box.sine, w = x * box.sine + z * box.cosine;
  const double from_x = box.place.x - base.place.x, from_z = box.place.z - base.place.z;
  if (std::abs(u) > std::abs(w)) {
    const double along = u > 0.0 ? -box.half_along : box.half_along;
    const auto near_end = static_cast<std::uint8_t>(u > 0.0 ? 0 : 1);
    return {from_x + along * box.cosine,
            from_z - along * box.sine,
            box.half_up * box.sine,
            box.half_up * box.cosine,
            near_end,
            static_cast<std::uint8_t>(near_end + 2)};
  }
  const double up = w > 0.0 ? -box.half_up : box.half_up;
  const auto near_end = static_cast<std::uint8_t>(w > 0.0 ? 0 : 2);
  return {from_x + up * box.sine,
          from_z + up * box.cosine,
          box.half_along * box.cosine,
          -box.half_along * box.sine,
          near_end,
          static_cast<std::uint8_t>(near_end + 1)};
}

// Clips the side of `other` that looks at a face of `base` by the two sides of that face. `x`, `z`: the face's outward normal; `along`:
// whether it is the face at the end of the box's own axis along the row.
void side_points(const PlaneBox& base, const PlaneBox& other, bool along, double x, double z, double margin, PlaneManifold& out) {
  const Side side = side_against(other, base, x, z);
  const unsigned of_base = out.face_of_a ? 0 : 4, of_other = out.face_of_a ? 4 : 0;
  // The tangent is the base's other axis; a hair's breadth wider, so that equal sides keep their corners.
  const double tx = along ? base.sine : base.cosine, tz = along ? base.cosine : -base.sine;
  const double half = along ? base.half_up : base.half_along, depth = along ? base.half_along : base.half_up;
  const double limit = half + 1e-7 * (base.half_along + base.half_up);
  // Places along the face, and distances from it, of the middle and of the way from there to the far end.
  const double t = side.x * tx + side.z * tz, t_way = side.to_x * tx + side.to_z * tz;
  const double distance = side.x * x + side.z * z - depth, distance_way = side.to_x * x + side.to_z * z;
  out.count = 0;
  if (std::abs(t) - std::abs(t_way) > limit) return;
  for (const double end : {-1.0, 1.0}) {
    double share = end;
    unsigned feature = of_other + (end < 0.0 ? side.near_end : side.far_end);
    const double there = t + end * t_way;
    if (std::abs(there) > limit) {
      share = ((there > 0.0 ? half : -half) - t) / t_way;
      const double normal_side = along ? x * base.cosine - z * base.sine : x * base.sine + z * base.cosine;
      const unsigned face_end = normal_side > 0.0 ? (along ? 1U : 2U) : 0U;
      feature = of_base + face_end + (there > 0.0 ? (along ? 2U : 1U) : 0U);
    }
    const double separation = distance + share * distance_way;
    out.parted = end < 0.0 ? separation : std::min(out.parted, separation);
    if (separation > margin) continue;
    out.points[static_cast<std::size_t>(out.count++)] = {base.place.x + side.x + share * side.to_x,
                                                         base.place.z + side.z + share * side.to_z, separation,
                                                         static_cast<std::uint8_t>(feature)};
  }
}

}  // namespace

void set_turn(PlaneBox& box) {
  const SinCos turn = sin_cos(box.place.turn);
  box.sine = turn.sin;
  box.cosine = turn.cos;
}

void touch_floor(const PlaneBox& a, double margin, PlaneManifold& out) {
  out.normal_x = 0.0;
  out.normal_z = 1.0;
  out.face_of_a = false;
  out.count = 0;
  const double reach = std::abs(a.sine) * a.half_along + std::abs(a.cosine) * a.half_up;
  out.parted = a.place.z - reach;
  if (out.parted > margin) return;
  // Of the two ends of each axis the lower one; the third corner is the lower of the two that are left.
  const unsigned lowest = (a.sine < 0.0 ? 0U : 1U) + (a.cosine > 0.0 ? 0U : 2U);
  const bool along = std::abs(a.sine) * a.half_along < std::abs(a.cosine) * a.half_up;
  const unsigned next = lowest ^ (along ? 1U : 2U);
  for (const unsigned which : {std::min(lowest, next), std::max(lowest, next)}) {
    const Corner corner = corner_of(a, which);
    if (corner.z > margin) continue;
    out.points[static_cast<std::size_t>(out.count++)] = {corner.x, corner.z, corner.z, corner.feature};
  }
}

void touch_boxes(const PlaneBox& a, const PlaneBox& b, double margin, PlaneManifold& out) {
  const double x = b.place.x - a.place.x, z = b.place.z - a.place.z;
  const double same = std::abs(a.cosine * b.cosine + a.sine * b.sine), other = std::abs(a.sine * b.cosine - a.cosine * b.sine);
  // What parted them before mostly still does.
  if (out.axis >= 0) {
    const PlaneBox& own = out.axis < 2 ? a : b;
    const PlaneBox& far = out.axis < 2 ? b : a;
    const bool along = out.axis % 2 == 0;
    const double distance = std::abs(along ? x * own.cosine - z * own.sine : x * own.sine + z * own.cosine);
    const double reach =
        along ? own.half_along + same * far.half_along + other * far.half_up : own.half_up + other * far.half_along + same * far.half_up;
    if (distance - reach > margin) {
      out.count = 0;
      out.parted = distance - reach;
      return;
    }
  }
  const std::array<double, 4> apart = {x * a.cosine - z * a.sine, x * a.sine + z * a.cosine, x * b.cosine - z * b.sine,
                                       x * b.sine + z * b.cosine};
  // Separating axes [Gottschalk1996], of which a rectangle has two.
  const std::array<double, 4> separation = {std::abs(apart[0]) - a.half_along - same * b.half_along - other * b.half_up,
                                            std::abs(apart[1]) - a.half_up - other * b.half_along - same * b.half_up,
                                            std::abs(apart[2]) - b.half_along - same * a.half_along - other * a.half_up,
                                            std::abs(apart[3]) - b.half_up - other * a.half_along - same * a.half_up};
  // A face is kept unless another one is clearly better.
  const double kept = 2e-3 * std::min(std::min(a.half_along, a.half_up), std::min(b.half_along, b.half_up));
  std::size_t best = 0;
  double best_score = -1e300;
  for (std::size_t k = 0; k < 4; ++k) {
    const double score = separation[k] + (static_cast<int>(k) == out.axis ? kept : 0.0);
    if (score > best_score) {
      best_score = score;
      best = k;
    }
  }
  out.axis = static_cast<int>(best);
  out.count = 0;
  out.parted = separation[best];
  out.face_of_a = best < 2;
  const PlaneBox& base = out.face_of_a ? a : b;
  const bool along = best % 2 == 0;
  const double side = (apart[best] > 0.0) == out.face_of_a ? 1.0 : -1.0;
  const double nx = side * (along ? base.cosine : base.sine), nz = side * (along ? -base.sine : base.cosine);
  out.normal_x = out.face_of_a ? -nx : nx;
  out.normal_z = out.face_of_a ? -nz : nz;
  if (separation[best] > margin) return;
  side_points(base, out.face_of_a ? b : a, along, nx, nz, margin, out);
}

}  // namespace topple::rigid
