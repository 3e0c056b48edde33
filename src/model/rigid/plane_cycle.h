/// How a plane front in an even row goes from one strike to the next.
#pragma once

#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

#include "model/rigid/plane_contact.h"
#include "model/rigid/plane_solver.h"
#include "topple/model.h"

namespace topple::rigid {

struct PlaneBrick {
  PlaneBox box;
  PlaneBox next;          ///< At the end of the part of the step that is tried.
  PlaneVec velocity;      ///< At this moment.
  PlaneVec middle;        ///< Mean over the drift that is planned.
  PlaneVec before_drift;  ///< Velocity when the last drift began.
  PlaneVec acceleration;  ///< Before the last blow.
  double mass = 0.0;      ///< [kg]
  double inertia = 0.0;   ///< About the axis across [kg m^2].
  double inverse_mass = 0.0, inverse_inertia = 0.0;
  double radius = 0.0;       ///< Of the circle around it [m].
  double thin = 0.0;         ///< Its thinnest side [m].
  double time_scale = 0.0;   ///< sqrt(longest side / gravity) [s].
  double quiet = 0.0;        ///< How long it has hardly moved [s].
  PlaneVec velocity_before;  ///< When rests were looked at last.
  PlaneVec listed_at;        ///< Where its list of neighbours was made.
  Quat upright;              ///< Its orientation as put down.
  double stand = 0.0;        ///< Where along the row it was put down [m].
  double aside = 0.0;        ///< How far it has been moved across the plane [m].
  BrickId id = kNoBrick;
  std::uint16_t kind = 0;
  int unknown = -1;  ///< Its place in the system of equations.
  bool moving = false;
  bool pushed = false;
  double path = 0.0;       ///< No corner has gone farther than this, all drifts together [m]...
  double next_path = 0.0;  ///< ...with the one that is tried.
  bool landed = false;
};

/// Of a brick at this velocity [J].
inline double kinetic_energy(const PlaneBrick& brick, const PlaneVec& v) {
  return 0.5 * (brick.mass * (v.x * v.x + v.z * v.z) + brick.inertia * v.turn * v.turn);
}

/// What a point remembers from moment to moment.
struct PlaneMemory {
  bool active = false;
  bool fresh = false;                           ///< Became active at the end of this part of the step.
  PointState kick, blow;                        ///< What it did in the last kick and in the last blow: the guess for the next one.
  double overlap = 0.0;                         ///< What is left of the overlap that its impact found [m].
  double normal = 0.0, tangent = 0.0;           ///< What it carried in the last kick [N].
  double leaning = 0.0, leaning_tangent = 0.0;  ///< What a brick that rests and leans on one that moves goes on to press with [N].
};

struct PlaneTouch {
  int a = 0;
  int b = -1;         ///< -1: the floor.
  double thin = 0.0;  ///< Of the thinner of the two [m].
  double friction = 0.0;
  double restitution = 0.0;
  PlaneManifold now, next;
  double apart_until = 0.0;  ///< It has no points before the paths of both bricks together are as long as this [m].
  std::array<PlaneMemory, 2> memory;
  double impulse = 0.0;  ///< Sum of the normal impulses of the last solution [N s].
  double load = 0.0;     ///< The force that they are [N].
  bool bearing = false;  ///< Of a pair of which one moves: they touched when the one came to rest or the other began to move.
  PlaneVec mark;         ///< Where the moving one was then.
};

/// What a point did, whose bricks are counted from one that was struck.
struct PatternPoint {
  int a = 0, b = 0;  ///< Places counted backwards from that brick.
  std::uint8_t feature = 0;
  PointState state;
};
using Pattern = std::vector<PatternPoint>;

/// All that decides how a front goes on from the moment after a strike; places along the row against the brick that was struck.
struct PlaneState {
  std::vector<PlaneBrick> bricks;
  std::vector<PlaneTouch> touches;
  std::vector<int> near_pairs;    ///< Those that have points, or may have some at the end of the drift that is tried.
  Pattern strike;                 ///< How the last strike went,
  std::array<Pattern, 16> leaps;  ///< and the leaps after it.
  BrickId last_struck = kNoBrick;
  std::size_t since_strike = 0;
  double planned_for = 0.0;  ///< `middle` is good for a drift of this time [s]; 0: for none.
  double since_look = 0.0;   ///< Time since neighbours and rests were looked at [s],
  int cuts = 0;              ///< and impacts located in it.
  bool rested = false;       ///< Some brick came to rest since the lists were made.

  auto all() {
    return std::tie(bricks, touches, near_pairs, strike, leaps, last_struck, since_strike, planned_for, since_look, cuts, rested);
  }
};

/// What a front did from one strike to the next. Bricks are numbered from the one that was struck at its beginning.
struct PlaneCycle {
  /// A brick that moves, as a drift began.
  struct Place {
    int brick = 0;
    bool landed = false;
    double quiet = 0.0;  ///< [s]
    double stand = 0.0;  ///< [m]
    PlaneVec place, velocity, middle, listed_at;
  };
  struct Arrival {
    int brick = 0;
    double time = 0.0;  ///< Since the drift began [s].
  };
  /// A brick goes from cell to cell of the neighbours.
  struct Move {
    int brick = 0;
    PlaneVec from, to;
  };
  struct Happening {
    Event event;  ///< Its bricks and the x of its point count from the struck one, too; its time is the drift's end.
    bool by_floor = false, somewhere = false;
  };
  /// One drift, and all that its end did.
  struct Drift {
    double whole = 0.0, cut = 0.0;  ///< [s]
    std::vector<Place> places;
    std::vector<Arrival> arrivals;
    std::vector<int> taken, left, woken;
    std::vector<PlaneBrick> rested;
    std::vector<Move> moves;
    std::vector<Happening> events;
  };
  std::vector<Drift> drifts;
  BrickId first = kNoBrick;  ///< The brick that was struck at its beginning.
  std::size_t count = 0;     ///< So many of them are this cycle's; the others wait to be used again.
  bool whole = true;         ///< Nothing happened in it that is not written down.
};

}  // namespace topple::rigid
