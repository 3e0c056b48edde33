/// The bricks of a front with six degrees of freedom and where they touch: what moves, and what it remembers from moment to moment.
#pragma once

#include <algorithm>
#include <vector>

#include "model/rigid/contact_solver.h"
#include "model/rigid/touch.h"
#include "model/rigid/wave.h"

namespace topple::rigid {

/// What a brick is known by besides its state: one that moves, or one within reach of those.
struct Member {
  Vec3 listed_at;                     ///< Where its list of neighbours was made [m].
  Vec3 velocity_before, spin_before;  ///< At the start of the step [m/s, rad/s].
  Vec3 local_up;                      ///< The vertical of its stance in its own axes.
  double thin = 0.0;                  ///< Its thinnest side [m].
  double time_scale = 0.0;            ///< sqrt(longest side / gravity) [s].
  double quiet = 0.0;                 ///< How long it has hardly moved [s].
  double stayed = 0.0;                ///< How long it has been near this place [s].
  Vec3 stays_at;                      ///< That place [m],
  Quat stays_turned;                  ///< and how it was turned there.
  Twist middle;                       ///< What carries it through the drift that is planned.
  Twist gain;                         ///< Acceleration in the last drift, before the last blow [m/s^2, rad/s^2].
  double tilt_cosine = 1.0;           ///< Of its tip angle.
  bool moving = false;
  bool lost = false;    ///< Another front has taken it in the same step.
  bool pushed = false;  ///< A force acts on it.
  bool landed = false;
  bool just_rested = false;  ///< In this step.
};

/// Bodies and members at the same places; a touch names two of them, or one and the floor.
struct FreeBricks {
  std::vector<Body> bodies;
  std::vector<Member> members;
  std::vector<Touch> touches;
  std::vector<ActiveForce> forces;

  Body& body(int place) { return bodies[static_cast<std::size_t>(place)]; }
  const Body& body(int place) const { return bodies[static_cast<std::size_t>(place)]; }
  Member& member(int place) { return members[static_cast<std::size_t>(place)]; }
  const Member& member(int place) const { return members[static_cast<std::size_t>(place)]; }
  const Touch& touch(int pair) const { return touches[static_cast<std::size_t>(pair)]; }
  Touch& touch(int pair) { return touches[static_cast<std::size_t>(pair)]; }
  /// The other brick of a touch, or null: the floor.
  const Body* second(const Touch& touch) const { return touch.b == kFloor ? nullptr : &body(touch.b); }

  /// Thinnest side of the thinner of the two [m].
  double thinner(const Touch& touch) const {
    return touch.b == kFloor ? member(touch.a).thin : std::min(member(touch.a).thin, member(touch.b).thin);
  }
  int place_of(BrickId brick) const;                          ///< -1: it is not among them.
  double closing_speed(const Touch& touch, int point) const;  ///< Along the normal [m/s].
  double moving_energy() const;                               ///< Kinetic [J].
  double spare_energy(double gravity) const;                  ///< What a rise of energy may be [J].
};

/// Points of a body and another one, or the floor if that is null, no farther than `margin` [m] apart; out.axis is read and set.
void touch_body(const Body& a, const Body* b, double margin, Manifold& out);

/// A ball's point is always the nearest one, however it turns: for the distance it is as if it did not.
inline Vec3 spin_of(const Body& body) { return body.round ? Vec3{} : body.angular_velocity; }

}  // namespace topple::rigid
