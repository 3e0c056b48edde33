/// What a pair of bricks, or a brick and the floor, remembers from step to step.
#pragma once

#include <array>

#include "model/rigid/contact.h"

namespace topple::rigid {

inline constexpr int kFloor = -1;

struct PointMemory {
  bool active = false;          ///< Takes part in the solution; a point that is only near does not.
  bool fresh = false;           ///< Became active at the end of this part of the step.
  double normal_force = 0.0;    ///< What the point carries, the first guess of the next solution [N].
  Vec3 friction_force;          ///< [N]
  double normal_impulse = 0.0;  ///< Of the first half of this part of the step [N s].
  Vec3 friction_impulse;        ///< [N s]
};

inline constexpr PointMemory kTouching{true, false, 0.0, {}, 0.0, {}};

struct Touch {
  int a = 0;
  int b = kFloor;  ///< Places in the front's list of bodies.
  int axis = -1;   ///< See touch_boxes.
  double friction = 0.0;
  double restitution = 0.0;
  Manifold manifold;
  std::array<PointMemory, 8> memory;
  double impulse = 0.0;  ///< Sum of the normal impulses of the last part of the step [N s].
  // Of a pair of which one moves and the other rests or stands on it or against it.
  bool bearing = false;  ///< They touched when the one came to rest or the other began to move.
  Vec3 mark_position;    ///< Where the moving one was then [m].
  Quat mark_orientation;
};

}  // namespace topple::rigid
