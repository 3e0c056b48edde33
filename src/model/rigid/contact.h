/// Where bricks touch each other and the floor: geometry alone.
#pragma once

#include <array>
#include <cstdint>

#include "model/rigid/brick_state.h"

namespace topple::rigid {

/// One point at which two bodies touch or nearly do.
struct TouchPoint {
  Vec3 position;              ///< [m]
  double separation = 0.0;    ///< Along the normal; < 0 where they overlap [m].
  std::uint32_t feature = 0;  ///< Which corner, edge or face made it: the same while the bodies slide on each other.
};

/// Which body's face gives the normal.
enum class Reference : std::uint8_t { a, b, edges };

/// All points of one pair. At most eight: a face clipped by a face.
struct Manifold {
  Vec3 normal;  ///< From b to a, unit.
  Reference reference = Reference::b;
  int axis = -1;        ///< Of two boxes: which of the 15 axes parted them, or gave the normal, so that most calls end early.
  double parted = 0.0;  ///< Where there is no point: how far apart they are along that axis [m].
  int count = 0;
  std::array<TouchPoint, 8> points;

  /// Becomes the same, without what lies behind the last point.
  void take(const Manifold& from);
};

/// Points of a box (or a ball) and the floor z = 0 no farther than `margin` [m] apart; the normal is up and b is the floor.
void touch_floor(const Body& a, double margin, Manifold& out);

/// Points of two boxes (or balls) no farther than `margin` [m] apart; out.axis is read and set.
void touch_boxes(const Body& a, const Body& b, double margin, Manifold& out);

}  // namespace topple::rigid
