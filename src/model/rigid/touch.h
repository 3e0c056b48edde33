/// What a pair of bricks, or a brick and the floor, remembers from step to step.
#pragma once

#include <array>

#include "model/rigid/contact.h"

namespace topple::rigid {

inline constexpr int kFloor = -1;

/// What a contact point does. Within one of these, but for the way it slides, everything is linear.
struct ContactState {
  bool pressed = true;  ///< Whether the normal impulse is above zero.
  bool slides = false;
};

struct PointMemory {
  bool active = false;        ///< Takes part in the solution; a point that is only near does not.
  bool fresh = false;         ///< Became active at the end of this part of the step.
  ContactState kick, blow;    ///< What it did in the last kick and in the last blow: the guess for the next one.
  double normal_force = 0.0;  ///< What the point carries, the first guess of the next solution [N].
  Vec3 friction_force;        ///< [N]
};

inline constexpr PointMemory kTouching{.active = true, .fresh = false, .kick = {}, .blow = {}, .normal_force = 0.0, .friction_force = {}};

struct Touch {
  int a = 0;
  int b = kFloor;  ///< Places in the front's list of bodies.
  double friction = 0.0;
  double restitution = 0.0;
  Manifold now, next;  ///< At this moment, and at the end of the part of the step that is tried.
  std::array<PointMemory, 8> memory;
  double impulse = 0.0;  ///< Sum of the normal impulses of the last solution [N s].
  double load = 0.0;     ///< The force that they are [N].
  // Of a pair of which one moves and the other rests or stands on it or against it.
  bool bearing = false;  ///< They touched when the one came to rest or the other began to move.
  Vec3 mark_position;    ///< Where the moving one was then [m].
  Quat mark_orientation;
};

}  // namespace topple::rigid
