#include "model/rigid/plane_bricks.h"

#include <cmath>

#include "base/trigonometry.h"

namespace topple::rigid {

int PlaneChain::place_of(BrickId brick) const {
  for (std::size_t i = 0; i < bricks.size(); ++i) {
    if (bricks[i].id == brick) return static_cast<int>(i);
  }
  return -1;
}

void PlaneChain::find_near_pairs() {
  near_pairs.clear();
  for (std::size_t i = 0; i < touches.size(); ++i) {
    if (touches[i].now.count + touches[i].next.count > 0) near_pairs.push_back(static_cast<int>(i));
  }
}

namespace {

// Of half the turn; by roots, which are exact everywhere, while it is less than a right angle and a half.
SinCos half_turn(const PlaneBox& box) {
  if (box.cosine < -0.7 || std::abs(box.place.turn) > 3.0) return sin_cos(0.5 * box.place.turn);
  const double cosine = std::sqrt(0.5 + 0.5 * box.cosine);
  return {.sin = 0.5 * box.sine / cosine, .cos = cosine};
}

}  // namespace

Pose pose_of(const RowPlane& plane, const World& world, const PlaneBrick& brick) {
  const SinCos half = half_turn(brick.box);
  const Quat turn{half.cos, half.sin * plane.across.x, half.sin * plane.across.y, 0.0};
  const Vec3 foot = world.foot(brick.id);
  const double moved = brick.box.place.x - brick.stand;
  const Vec3 place = {foot.x + (moved * plane.along.x + brick.aside * plane.across.x),
                      foot.y + (moved * plane.along.y + brick.aside * plane.across.y), brick.box.place.z};
  return {place, turn * brick.upright};
}

FreeMotion motion_of(const RowPlane& plane, const World& world, const PlaneBrick& brick, Phase phase) {
  const PlaneVec& v = brick.velocity;
  return {brick.id, phase, pose_of(plane, world, brick), v.x * plane.along + Vec3{0.0, 0.0, v.z}, v.turn * plane.across};
}

}  // namespace topple::rigid
