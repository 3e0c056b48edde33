/// The vertical plane of a straight row, and what lies in it.
#pragma once

#include "model/rigid/plane_contact.h"
#include "model/rigid/world.h"

namespace topple::rigid {

/// The plane of a row: mirror images about it are the same, so nothing ever moves out of it.
struct RowPlane {
  Vec3 origin;              ///< [m]
  Vec3 along;               ///< The way the row heads; horizontal, unit.
  Vec3 across;              ///< To its left.
  double zero = 0.0;        ///< How far along the plane a front begins to count its places [m].
  double pitch = 0.0;       ///< From brick to brick of that front [m].
  double half_width = 0.0;  ///< Of the widest of its bricks [m].
};

/// The plane in which a brick would fall.
RowPlane plane_of_row(const World& world, BrickId brick);

/// Whether a brick was put down in this plane: a box on the floor, across it.
bool put_down_in(const RowPlane& plane, const World& world, BrickId brick);

/// Pitches that differ by less are the same: rounding of places, to 2^-28 each way.
inline constexpr double kSamePitch = 2e-8;

/// How far along the plane a brick was put down, from its origin [m].
double stand_along(const RowPlane& plane, const World& world, BrickId brick);

/// A point of the plane, so far along it from `zero` and so high [m].
inline Vec3 in_world(const RowPlane& plane, double x, double z) {
  const double along = plane.zero + x;
  return {plane.origin.x + along * plane.along.x, plane.origin.y + along * plane.along.y, z};
}

/// A pose taken apart: where it is in the plane, along it against where it was put down, and what is left.
struct PlanePose {
  PlaneVec place;
  double lateral = 0.0;  ///< [m]
  Quat upright;          ///< The orientation without the turn in the plane.
  double swing = 0.0;    ///< How far `upright` is turned away from the brick as put down [rad].
};
PlanePose in_plane(const RowPlane& plane, const World& world, BrickId brick, const Pose& pose);

/// Where a brick that does not move is in a plane.
struct InPlane {
  bool lies = false;    ///< In the plane; one that rests after it has moved freely, to Tolerances::in_plane.
  bool misses = false;  ///< Its width does not reach any of the plane's bricks.
  PlaneVec place;       ///< Along the plane against where it was put down.
};
InPlane locate_in(const RowPlane& plane, const World& world, BrickId brick, const Still& still);

}  // namespace topple::rigid
