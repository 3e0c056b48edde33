// One brick as it stands and as it turns about its toe or heel, in closed form.
#include <algorithm>
#include <cmath>

#include "base/trigonometry.h"
#include "topple/layout.h"

namespace topple {
namespace {

constexpr double kHalfRoot = 0.70710678118654752440;  // sin and cos of 45 degrees

/// Takes the brick's own axes (thickness, width, height) to (along, across, up) of its stance.
/// A flat brick lies as one that has fallen the way it heads; one on its side lies on its right.
Quat stance_turn(Stance stance) {
  switch (stance) {
    case Stance::flat:
      return {kHalfRoot, 0.0, kHalfRoot, 0.0};
    case Stance::on_side:
      return {kHalfRoot, kHalfRoot, 0.0, 0.0};
    case Stance::standing:
      break;
  }
  return {};
}

/// The own axis of a brick that points up as it was put down.
Vec3 up_axis(Stance stance) {
  switch (stance) {
    case Stance::flat:
      return {-1.0, 0.0, 0.0};
    case Stance::on_side:
      return {0.0, 1.0, 0.0};
    case Stance::standing:
      break;
  }
  return {0.0, 0.0, 1.0};
}

}  // namespace

const Part* Layout::part_of(BrickId brick) const {
  const auto after = std::upper_bound(parts.begin(), parts.end(), brick, [](BrickId id, const Part& part) { return id < part.first; });
  if (after == parts.begin()) return nullptr;
  const Part& part = *(after - 1);
  return brick < part.first + part.count ? &part : nullptr;
}

Extents extents(const BrickKind& kind, Stance stance) {
  switch (stance) {
    case Stance::flat:
      return {kind.height, kind.width, kind.thickness};
    case Stance::on_side:
      return {kind.thickness, kind.height, kind.width};
    case Stance::standing:
      break;
  }
  return {kind.thickness, kind.width, kind.height};
}

double tip_angle(const Extents& size) { return arc_tangent(size.along, size.up); }

Vec3 half_extents(const BrickKind& kind) { return {kind.thickness / 2.0, kind.width / 2.0, kind.height / 2.0}; }

Pose standing_pose(const Layout& layout, BrickId brick) {
  return standing_pose(layout.kind_of(brick), layout.bricks[static_cast<std::size_t>(brick)]);
}

Pose standing_pose(const BrickKind& kind, const Brick& put) {
  const Extents size = extents(kind, put.stance);
  const SinCos half = sin_cos(put.heading / 2.0);
  const Quat heading{half.cos, 0.0, 0.0, half.sin};
  return {put.foot + Vec3{0.0, 0.0, size.up / 2.0}, heading * stance_turn(put.stance)};
}

Pose hinged_pose(const Layout& layout, BrickId brick, double angle) {
  const Brick& put = layout.bricks[static_cast<std::size_t>(brick)];
  const Extents size = extents(layout.kind_of(brick), put.stance);
  const SinCos half_heading = sin_cos(put.heading / 2.0);
  const SinCos half_angle = sin_cos(angle / 2.0);
  // The edge it turns about: the toe ahead of the foot, or the heel behind it. From there the centre lies at (-edge, up / 2).
  const double edge = angle < 0.0 ? -size.along / 2.0 : size.along / 2.0;
  const double sine = 2.0 * half_angle.sin * half_angle.cos;
  const double versine = 2.0 * half_angle.sin * half_angle.sin;  // 1 - cos, without cancellation
  const double ahead = edge * versine + sine * size.up / 2.0;
  const double rise = sine * edge - versine * size.up / 2.0;
  const double cos_heading = half_heading.cos * half_heading.cos - half_heading.sin * half_heading.sin;
  const double sin_heading = 2.0 * half_heading.sin * half_heading.cos;
  const Quat turn = Quat{half_heading.cos, 0.0, 0.0, half_heading.sin} * Quat{half_angle.cos, 0.0, half_angle.sin, 0.0};
  return {put.foot + Vec3{ahead * cos_heading, ahead * sin_heading, size.up / 2.0 + rise}, turn * stance_turn(put.stance)};
}

double tilt(const Layout& layout, BrickId brick, const Quat& orientation) {
  const Vec3 up = rotate(orientation, up_axis(layout.bricks[static_cast<std::size_t>(brick)].stance));
  return arc_tangent(std::sqrt(up.x * up.x + up.y * up.y), up.z);
}

}  // namespace topple
