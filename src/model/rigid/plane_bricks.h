/// The bricks of a plane front and where they touch: what moves, and what it remembers from moment to moment.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/rigid/plane_contact.h"
#include "model/rigid/plane_solver.h"
#include "model/rigid/row_plane.h"
#include "topple/model.h"

namespace topple::rigid {

/// A brick of a plane front: one that moves, or one within reach of those. Places along the row count from RowPlane::zero.
struct PlaneBrick {
  PlaneBox box;
  PlaneBox next;                                     ///< At the end of the drift, or the part of it, that is tried.
  PlaneVec velocity;                                 ///< At this moment.
  PlaneVec middle;                                   ///< Mean over the drift that is planned.
  PlaneVec before_drift;                             ///< Velocity when the last drift began.
  PlaneVec acceleration;                             ///< Before the last blow [m/s^2, rad/s^2].
  double mass = 0.0;                                 ///< [kg]
  double inertia = 0.0;                              ///< About the axis across [kg m^2].
  double inverse_mass = 0.0, inverse_inertia = 0.0;  ///< [1/kg], [1/(kg m^2)]
  double radius = 0.0;                               ///< Of the circle around it [m].
  double thin = 0.0;                                 ///< Its thinnest side [m].
  double time_scale = 0.0;                           ///< sqrt(longest side / gravity) [s].
  double quiet = 0.0;                                ///< How long it has hardly moved [s].
  PlaneVec velocity_before;                          ///< When rests were looked at last.
  PlaneVec listed_at;                                ///< Where its list of neighbours was made.
  Quat upright;                                      ///< Its orientation as put down.
  double stand = 0.0;                                ///< Where along the row it was put down [m].
  double aside = 0.0;                                ///< How far it has been moved across the plane [m].
  BrickId id = kNoBrick;
  std::uint16_t kind = 0;  ///< Of World::kinds.
  int unknown = -1;        ///< Its place in the system of equations.
  bool moving = false;
  bool pushed = false;     ///< A force acts on it.
  double path = 0.0;       ///< No corner has gone farther than this, all drifts together [m]...
  double next_path = 0.0;  ///< ...with the one that is tried.
  bool landed = false;     ///< Its landing has been told.
};

/// Of a brick at this velocity [J].
inline double kinetic_energy(const PlaneBrick& brick, const PlaneVec& v) {
  return 0.5 * (brick.mass * (v.x * v.x + v.z * v.z) + brick.inertia * v.turn * v.turn);
}

/// What a point remembers from moment to moment.
struct PlaneMemory {
  bool active = false;                          ///< Takes part in the solution; a point that is only near does not.
  bool fresh = false;                           ///< Became active at the end of the last drift.
  PointState kick, blow;                        ///< What it did in the last kick and in the last blow: the guess for the next one.
  double overlap = 0.0;                         ///< What is left of the overlap that its impact found [m].
  double normal = 0.0, tangent = 0.0;           ///< What it carried in the last kick [N].
  double leaning = 0.0, leaning_tangent = 0.0;  ///< What a brick that rests and leans on one that moves goes on to press with [N].
};

/// A pair of bricks, or a brick and the floor, that may touch.
struct PlaneTouch {
  int a = 0;          ///< Places in the chain.
  int b = -1;         ///< -1: the floor.
  double thin = 0.0;  ///< Of the thinner of the two [m].
  double friction = 0.0;
  double restitution = 0.0;
  PlaneManifold now, next;            ///< At this moment, and at the end of the drift that is tried.
  double apart_until = 0.0;           ///< It has no points before the paths of both bricks together are as long as this [m].
  std::array<PlaneMemory, 2> memory;  ///< Of the points of `now`.
  double impulse = 0.0;               ///< Sum of the normal impulses of the last solution [N s].
  double load = 0.0;                  ///< The force that they are [N].
  bool bearing = false;               ///< Of a pair of which one moves: they touched when the one came to rest or the other began to move.
  PlaneVec mark;                      ///< Where the moving one was then.
};

/// A push at work on one brick, along the row.
struct PlaneForce {
  BrickId brick = kNoBrick;
  double along = 0.0;       ///< [N]
  double x = 0.0, z = 0.0;  ///< Where it acts, in the brick's own axes [m].
  double end = 0.0;         ///< [s]
};

/// Bricks in the order of their places along the row; touches by the later brick of each.
struct PlaneChain {
  std::vector<PlaneBrick> bricks;
  std::vector<PlaneTouch> touches;
  std::vector<int> near_pairs;  ///< Touches that have points, or may have some at the end of the drift that is tried.
  std::vector<PlaneForce> forces;

  PlaneBrick& brick(int place) { return bricks[static_cast<std::size_t>(place)]; }
  const PlaneBrick& brick(int place) const { return bricks[static_cast<std::size_t>(place)]; }
  PlaneTouch& touch(int pair) { return touches[static_cast<std::size_t>(pair)]; }
  const PlaneTouch& touch(int pair) const { return touches[static_cast<std::size_t>(pair)]; }
  int place_of(BrickId brick) const;  ///< -1: it is not among them.
  void find_near_pairs();
};

/// What a point did, whose bricks are counted from one that was struck.
struct PatternPoint {
  int a = 0, b = 0;  ///< Places counted backwards from that brick.
  std::uint8_t feature = 0;
  PointState state;
};
using Pattern = std::vector<PatternPoint>;

/// All that decides how a front goes on from a moment between two drifts.
struct PlaneState : PlaneChain {
  Pattern strike;                 ///< How the last strike went,
  std::array<Pattern, 16> leaps;  ///< and the leaps after it.
  BrickId last_struck = kNoBrick;
  std::size_t since_strike = 0;  ///< Leaps.
  double planned_for = 0.0;      ///< PlaneBrick::middle is good for a drift of this time [s]; 0: for none.
  double since_look = 0.0;       ///< Time since neighbours and rests were looked at [s],
  int cuts = 0;                  ///< and impacts located in it.
  bool rested = false;           ///< Some brick came to rest since the lists were made.
};

/// Where a brick is in space, and how it moves.
Pose pose_of(const RowPlane& plane, const World& world, const PlaneBrick& brick);
FreeMotion motion_of(const RowPlane& plane, const World& world, const PlaneBrick& brick, Phase phase);

}  // namespace topple::rigid
