#include "model/rigid/row_plane.h"

#include <algorithm>
#include <cmath>

#include "base/trigonometry.h"

namespace topple::rigid {

namespace {

// Off the plane by less than this, as a fraction of the thickness or in radians, a brick is in it: rounding of places and headings.
constexpr double kInPlane = 1e-7;

double thinnest(const BrickKind& kind) { return std::min({kind.height, kind.width, kind.thickness}); }

bool heads_along(const RowPlane& plane, double direction) {
  const SinCos heading = sin_cos(direction);
  return std::abs(heading.sin * plane.along.x - heading.cos * plane.along.y) < kInPlane;
}

}  // namespace

RowPlane plane_of_row(const World& world, BrickId brick) {
  const SinCos turn = sin_cos(world.heading(brick));
  return {.origin = world.foot(brick), .along = {turn.cos, turn.sin, 0.0}, .across = {-turn.sin, turn.cos, 0.0}};
}

bool put_down_in(const RowPlane& plane, const World& world, BrickId brick) {
  const BrickKind& kind = world.kind_of(brick);
  const Vec3 foot = world.foot(brick);
  return kind.shape == Shape::box && foot.z <= 0.0 && heads_along(plane, world.heading(brick)) &&
         std::abs(dot(foot - plane.origin, plane.across)) < kInPlane * thinnest(kind);
}

double stand_along(const RowPlane& plane, const World& world, BrickId brick) { return dot(world.foot(brick) - plane.origin, plane.along); }

PlanePose in_plane(const RowPlane& plane, const World& world, BrickId brick, const Pose& pose) {
  const Quat turned = pose.orientation * conjugate(world.standing(brick).orientation);
  const double about = turned.x * plane.across.x + turned.y * plane.across.y;
  const double roll = turned.x * plane.along.x + turned.y * plane.along.y;
  const Vec3 apart = pose.position - plane.origin;
  PlanePose out;
  const Vec3 moved = pose.position - world.foot(brick);
  out.place = {dot(moved, plane.along), pose.position.z, 2.0 * arc_tangent(turned.w < 0.0 ? -about : about, std::abs(turned.w))};
  out.lateral = dot(apart, plane.across);
  const SinCos half = sin_cos(0.5 * out.place.turn);
  out.upright = Quat{half.cos, -half.sin * plane.across.x, -half.sin * plane.across.y, 0.0} * pose.orientation;
  out.swing = 2.0 * std::sqrt(roll * roll + turned.z * turned.z);
  return out;
}

InPlane locate_in(const RowPlane& plane, const World& world, BrickId brick, const Still& still) {
  const BrickKind& kind = world.kind_of(brick);
  const PlanePose apart = in_plane(plane, world, brick, still.pose);
  const double thin = thinnest(kind);
  const bool fits = kind.shape == Shape::box && world.given(brick).foot.z <= 0.0 && heads_along(plane, world.heading(brick));
  InPlane out;
  out.lies = fits && std::abs(apart.lateral) < kInPlane * thin && apart.swing < kInPlane;
  if (fits && still.rests) {
    out.lies = std::abs(apart.lateral) + norm(half_extents(kind)) * apart.swing < world.tolerances.in_plane * thin;
  }
  out.place = apart.place;
  if (!out.lies) {
    const Vec3 half = half_extents(kind);
    const Vec3 local = rotate(conjugate(still.pose.orientation), plane.across);
    const double reach = std::abs(local.x) * half.x + std::abs(local.y) * half.y + std::abs(local.z) * half.z;
    out.misses = std::abs(apart.lateral) > plane.half_width + reach + world.tolerances.margin * thin;
  }
  return out;
}

}  // namespace topple::rigid
