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
  std::size_t count = 0;  ///< 0: there is no leg.
  bool reached = false;   ///< It ends at the angle that was asked for.

  const FrontState& end() const { return nodes[count - 1]; }
  FrontState at_time(double time) const;
  double time_of(double angle) const;  ///< When the front passes an angle of this leg [s].
};

struct LegGoal {
  double angle = 0.0;      ///< Where the next event is [rad].
  double direction = 1.0;  ///< +1: falls, -1: returns.
  double slow_step = 0.0;  ///< Time step where the front is slow [s].
};

/// Moves on from `start` as far towards the goal as it can in one leg. Where the square of the rate is smooth over the angle, this is one
/// collocation step; where the front nearly stops or turns round, one Runge-Kutta step in time.
Leg make_leg(const Train& train, const FrontState& start, const LegGoal& goal);

/// Only the second way. The plain one, to which the first is held by a test.
Leg make_slow_leg(const Train& train, const FrontState& start, const LegGoal& goal);

}  // namespace topple::hinge
