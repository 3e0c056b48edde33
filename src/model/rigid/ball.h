/// Balls: where they touch, and what slows their rolling.
#pragma once

#include "model/rigid/contact.h"

namespace topple::rigid {

/// The point of a ball and the floor, as touch_floor.
void touch_floor_with_ball(const Body& ball, double margin, Manifold& out);

/// The point of two bodies of which at least one is a ball, as touch_boxes.
void touch_ball(const Body& a, const Body& b, double margin, Manifold& out);

/// Rolling resistance on the floor for `time` [s]: a ball that rolls without sliding loses 5/7 of `coefficient` times gravity times the
/// time from its speed, and turns slower by as much.
void resist_rolling(Body& ball, double coefficient, double gravity, double time);

}  // namespace topple::rigid
