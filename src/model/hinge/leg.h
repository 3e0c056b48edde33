/// A leg: the motion of a train's front between two events, in angle and time.
#pragma once

#include <array>
#include <cstddef>

#include "model/hinge/train.h"

namespace topple::hinge {

/// The front of a train at a moment.
struct FrontState {
  double time = 0.0;          ///< [s]
  double angle = 0.0;         ///< [rad]
  double rate = 0.0;          ///< [rad/s]
  double acceleration = 0.0;  ///< [rad/s^2]
};

/// Nodes in the order of time; between two of them the angle is the quintic polynomial through angle, rate and acceleration.
struct Leg {
  static constexpr std::size_t kMostNodes = 5;
  std::array<FrontState, kMostNodes> nodes;
  std::size_t count = 0;    ///< 0: there is no leg.
  bool reached = false;     ///< It ends at the angle that was asked for.
  bool swept = false;       ///< The train's goal fields are those of the goal, and the next three are known.
  bool turns_over = false;  ///< On the way to the goal a lean turns over, by more than the slack.
  bool touches = false;     ///< At the goal a lean is about to turn over.
  FrontView goal_view;

  const FrontState& end() const { return nodes[count - 1]; }
  FrontState at_time(double time) const;
  double time_of(double angle) const;  ///< When the front passes an angle of this leg [s].
};

struct LegGoal {
  double angle = 0.0;      ///< Where the next event is [rad].
  double direction = 1.0;  ///< +1: falls, -1: returns.
  double slow_step = 0.0;  ///< Time step where the front is slow [s].
  double slack = 0.0;      ///< How far a lean may pass the end of its edge before it must turn over, as a fraction of the thickness ahead.
  FrontView start;         ///< The train where the leg starts.
};

/// Moves on from `start` as far towards the goal as it can in one leg. Where the square of the rate is smooth over the angle, this is one
/// collocation step; where the front nearly stops or turns round, one Runge-Kutta step in time.
Leg make_leg(Train& train, const FrontState& start, const LegGoal& goal);

/// Only the second way: the plain one, to which the first is held by a test.
Leg make_slow_leg(const Train& train, const FrontState& start, const LegGoal& goal);

}  // namespace topple::hinge
