/// What all contacts of a plane front do at one moment: from the points that touch to the velocities of its bricks.
#pragma once

#include <span>
#include <vector>

#include "model/rigid/plane_bricks.h"
#include "model/rigid/plane_solver.h"

namespace topple::rigid {

/// Kicks (the forces of half a drift before a moment and half a drift after it) and blows.
class PlaneImpulses {
 public:
  PlaneImpulses(const World& world, PlaneState& state) : world_(world), state_(state), solver_(*world.kernels) {}

  /// Half a kick from the velocities of this moment, for a drift of `time` [s]; together with a blow, if there is one, and the brick that
  /// is struck by it, if one is.
  void plan(double time, bool with_blow, BrickId struck = kNoBrick);
  /// A kick from the middle of a drift of `time` to that of one of `next` [s]; the velocity of this moment lies between.
  void leap(double time, double next);
  /// New points touch: the blow acts together with half a kick for the drift of `next` that follows. A bounce, which needs the blow by
  /// itself, comes before that; whether there was one. The drift before was planned for `whole` [s].
  bool take_blow(double whole, double next, BrickId struck);
  /// A blow by itself, `always` or only if something bounces; whether there was one.
  bool blow(bool always);
  /// Whether a point that has begun to touch closes so fast that it deserves a blow; a slower one is stopped by the next kick.
  bool closes_fast() const;
  std::span<const PlaneRow> rows() const { return rows_; }  ///< With the impulses of the last plan, leap or blow.

 private:
  void make_rows(PointState PlaneMemory::* guess);
  void begin_with(PlaneVec PlaneBrick::* velocity, std::span<PlaneUnknown> unknowns) const;
  void set_bias(double time, bool after_blow = false);
  static PlaneVec after_the_blow(const PlaneBrick& brick, double time);
  bool bends_otherwise(double time);
  void kick(double time);
  void solve_half_a_kick(double time);
  void recall(const Pattern& pattern, int head, int most = 1 << 20);
  void keep(Pattern& pattern, int head, int most = 1 << 20) const;
  void remember_impulses(double time, PointState PlaneMemory::* states);
  void stop_at_once();
  void give_back();
  void bounce_by(double share);

  const World& world_;
  PlaneState& state_;
  std::vector<PlaneRow> rows_, compression_;
  std::vector<PlaneUnknown> unknowns_, before_blow_;
  PlaneSolver solver_;
};

}  // namespace topple::rigid
