/// Bricks that move in one vertical plane, and where they touch: three degrees of freedom each.
#pragma once

#include <array>
#include <cstdint>

#include "topple/layout.h"

namespace topple::rigid {

/// Along the row, up, and turned about the axis across it (the way the row heads): a place or its rate of change.
struct PlaneVec {
  double x = 0.0;     ///< [m] or [m/s]
  double z = 0.0;     ///< [m] or [m/s]
  double turn = 0.0;  ///< [rad] or [rad/s]
};
constexpr PlaneVec operator+(const PlaneVec& a, const PlaneVec& b) { return {a.x + b.x, a.z + b.z, a.turn + b.turn}; }
constexpr PlaneVec operator-(const PlaneVec& a, const PlaneVec& b) { return {a.x - b.x, a.z - b.z, a.turn - b.turn}; }
constexpr PlaneVec operator*(double s, const PlaneVec& a) { return {s * a.x, s * a.z, s * a.turn}; }

/// The section of a brick: a rectangle.
struct PlaneBox {
  PlaneVec place;           ///< Of its centre.
  double sine = 0.0;        ///< Of its turn: the axis that was up is (sine, cosine),
  double cosine = 1.0;      ///< the one that pointed along the row (cosine, -sine).
  double half_along = 0.0;  ///< [m]
  double half_up = 0.0;     ///< [m]
};
void set_turn(PlaneBox& box);  ///< Sine and cosine from the place.

/// One point at which two sections touch or nearly do. Its feature is a corner: of the first box 0 to 3, of the second 4 to 7 (bit 0: the
/// far end along, bit 1: the upper end).
struct PlanePoint {
  double x = 0.0, z = 0.0;  ///< [m]
  double separation = 0.0;  ///< Along the normal; < 0 where they overlap [m].
  std::uint8_t feature = 0;
};

/// All points of a pair: at most two.
struct PlaneManifold {
  double normal_x = 0.0, normal_z = 1.0;  ///< From b to a, unit.
  double parted = 0.0;                    ///< Where there is no point: how far apart they are along the best axis [m].
  bool face_of_a = false;                 ///< The normal turns with a, not with b.
  int axis = -1;  ///< Which face gave the normal or parted the boxes: 0, 1 of a, 2, 3 of b; kept if nothing is clearly better.
  int count = 0;
  std::array<PlanePoint, 2> points;
};

/// Points of a box and the floor z = 0 no farther than `margin` [m] apart.
void touch_floor(const PlaneBox& a, double margin, PlaneManifold& out);

/// Points of two boxes no farther than `margin` [m] apart.
void touch_boxes(const PlaneBox& a, const PlaneBox& b, double margin, PlaneManifold& out);

}  // namespace topple::rigid
