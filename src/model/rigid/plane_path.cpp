// From states of the points that contradict each other to those that do not, one change after the other.
//
// Newton's method jumps from states to states, and may jump to and fro. Here all slips go along a path [Katzenelson1965]. It begins where
// each slip is one of the state that its point is in; where the equations want it otherwise, the law of that point is shifted by the
// difference, and along the path all shifts are taken back together. Within given states everything is linear, so the slips go straight to
// those that the equations give without any shift, until one of them reaches the edge of its state. That state changes, the equations are
// solved anew, and the slips go on from where they are. Where this leads back over the same edge, the path has turned: it goes on with
// shifts that grow, until another edge turns it again. If they grow to more than they were at its beginning, it is given up.
#include <algorithm>
#include <cmath>
#include <limits>

#include "model/rigid/plane_solver.h"

namespace topple::rigid {

namespace {

constexpr int kMostChanges = 60;
constexpr double kInside = 0.1;  // So far inside of its state a slip begins that the equations want outside of it [sqrt(length gravity)].

// Where a state ends.
enum class Edge : std::uint8_t { pressing, forward, backward };

bool rubs(const PlaneRow& row) { return row.state.pressed || row.base > 0.0; }

// The slip at which friction takes all that it can [m/s].
double limit_of(const PlaneRow& row, double normal) {
  return row.friction * (row.base + (row.state.pressed ? -row.normal_stiffness * normal : 0.0)) / row.tangent_stiffness;
}

// How far a slip is beyond an edge of the state of its point; below zero inside [m/s].
double beyond(const PlaneRow& row, Edge edge, const PlaneSlip& slip) {
  if (edge == Edge::pressing) return row.state.pressed ? slip.normal : -slip.normal;
  const double sliding = (edge == Edge::forward ? slip.tangent : -slip.tangent) - limit_of(row, slip.normal);
  return row.state.grip == Grip::stick ? sliding : -sliding;
}

// The slip inside of the point's state that a path begins with where the equations want `wanted`.
PlaneSlip begin_at(const PlaneRow& row, const PlaneSlip& wanted) {
  PlaneSlip slip = wanted;
  slip.normal = row.state.pressed ? std::min(slip.normal, -kInside) : std::max(slip.normal, kInside);
  if (!rubs(row)) return slip;
  const double limit = limit_of(row, slip.normal), less = limit - std::min(kInside, 0.5 * limit), more = limit + kInside;
  switch (row.state.grip) {
    case Grip::stick:
      slip.tangent = std::clamp(slip.tangent, -less, less);
      break;
    case Grip::forward:
      slip.tangent = std::max(slip.tangent, more);
      break;
    case Grip::backward:
      slip.tangent = std::min(slip.tangent, -more);
      break;
  }
  return slip;
}

// The state on the other side of an edge, which the slip has reached.
PointState across(const PlaneRow& row, Edge edge, const PlaneSlip& slip) {
  PointState state = row.state;
  if (edge == Edge::pressing) {
    state.pressed = !state.pressed;
    if (row.base > 0.0) return state;
    // Friction begins and ends with the pressure, and sliding.
    state.grip = !state.pressed ? Grip::stick : slip.tangent > 0.0 ? Grip::forward : Grip::backward;
  } else if (state.grip == Grip::stick) {
    state.grip = edge == Edge::forward ? Grip::forward : Grip::backward;
  } else {
    state.grip = Grip::stick;
  }
  return state;
}

struct Stop {
  double share;           // Of the way from `held` to `wanted`.
  std::size_t point = 0;  // The first to reach an edge...
  Edge edge = Edge::pressing;
  bool any = false;  // ...if one does.
};

// The first edge on the way from `held` to `wanted`, or (`way` < 0) on the one that leads away from it.
Stop first_edge(std::span<const PlaneRow> rows, std::span<const PlaneSlip> held, std::span<const PlaneSlip> wanted, double way) {
  Stop first{.share = way > 0.0 ? 1.0 : std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto look_at = [&](Edge edge) {
      const double there = beyond(rows[k], edge, wanted[k]);
      if (way > 0.0 && there <= 0.0) return;
      const double here = beyond(rows[k], edge, held[k]), rate = way * (there - here);
      if (rate <= 0.0) return;
      const double share = std::max(-here, 0.0) / rate;
      if (share < first.share) first = {.share = share, .point = k, .edge = edge, .any = true};
    };
    look_at(Edge::pressing);
    if (!rubs(rows[k])) continue;
    if (rows[k].state.grip != Grip::backward) look_at(Edge::forward);
    if (rows[k].state.grip != Grip::forward) look_at(Edge::backward);
  }
  return first;
}

}  // namespace

void PlaneSolver::begin_path(std::span<PlaneRow> rows) {
  held_.clear();
  wanted_.clear();
  for (PlaneRow& row : rows) {
    if (!rubs(row)) row.state.grip = Grip::stick;
    wanted_.push_back(slip_of(row, velocity_));
    held_.push_back(begin_at(row, wanted_.back()));
  }
}

// From the states that the rows hold and the velocities that follow from them. Whether it led to states that agree with their velocities.
bool PlaneSolver::follow_path(std::span<PlaneRow> rows) {
  begin_path(rows);
  double way = 1.0;    // 1: towards what the equations want; -1: away from it.
  double shift = 1.0;  // What is left of the shifts, as a share of those at the beginning.
  for (int i = 0; i < kMostChanges; ++i) {
    const Stop stop = first_edge(rows, held_, wanted_, way);
    if (!stop.any) return way > 0.0;
    const double share = way * stop.share;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      held_[k].normal += share * (wanted_[k].normal - held_[k].normal);
      held_[k].tangent += share * (wanted_[k].tangent - held_[k].tangent);
    }
    shift *= 1.0 - share;
    if (shift > 1.0) return false;
    PlaneRow& row = rows[stop.point];
    PlaneSlip& held = held_[stop.point];
    if (stop.edge == Edge::pressing) held.normal = 0.0;
    if (!solve_system(change(row, across(row, stop.edge, held)))) return false;
    for (std::size_t k = 0; k < rows.size(); ++k) wanted_[k] = slip_of(rows[k], velocity_);
    if (way * (beyond(row, stop.edge, wanted_[stop.point]) - beyond(row, stop.edge, held)) > 0.0) way = -way;
  }
  return false;
}

}  // namespace topple::rigid
