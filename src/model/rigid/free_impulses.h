/// What all contacts of a front with six degrees of freedom do at one moment: from the points that touch to the velocities of its bricks.
#pragma once

#include <span>
#include <vector>

#include "model/rigid/contact_solver.h"
#include "model/rigid/free_bricks.h"

namespace topple::rigid {

/// Kicks (the forces of half a drift before a moment and half a drift after it) and blows.
class FreeImpulses {
 public:
  FreeImpulses(const World& world, FreeBricks& bricks) : world_(world), bricks_(bricks), solver_(*world.kernels) {}

  /// Half a kick from the velocities of this moment, for a drift of `time` [s]; together with a blow, if there is one.
  void plan(double time, bool with_blow);
  /// A kick from the middle of a drift of `time` to that of one of `next` [s]; the velocity of this moment lies between.
  void leap(double time, double next);
  /// New points touch: the blow acts together with half a kick for the drift of `next` [s] that follows. A bounce, which needs the blow by
  /// itself, comes before that, and so does every blow if velocities are `read_now`; whether there was one.
  bool take_blow(double next, bool read_now);
  /// A blow by itself, `always` or only if something bounces; whether there was one.
  bool blow(bool always);
  /// Whether a point that has begun to touch closes so fast that it deserves a blow; a slower one is stopped by the next kick.
  bool closes_fast() const;

  double planned_for() const { return planned_for_; }  ///< Member::middle is good for a drift of this time [s]; 0: for none.
  void forget_plan() { planned_for_ = 0.0; }
  std::span<const ContactRow> rows() const { return rows_; }  ///< With the impulses of the last plan, leap or blow.

 private:
  void make_rows(ContactState PointMemory::* guess, double time);
  void set_bias(double time);
  void kick(double time);
  void slow_ball(std::size_t place, double time);
  void solve_contacts(std::span<const Twist> guess);
  void solve_half_a_kick(double time);
  static Twist after_the_blow(const Member& member, double time);
  bool bends_otherwise(double time);
  void remember_impulses(double time, ContactState PointMemory::* states, bool with_blow = false);
  void stop_at_once();
  void give_back(double before);
  void bounce_by(double share);

  const World& world_;
  FreeBricks& bricks_;
  std::vector<ContactRow> rows_, compression_;
  std::vector<Vec3> bends_;  // Of each row: what the bend of its points' paths adds to their slip [m/s].
  std::vector<Twist> guess_, now_, free_;
  double planned_for_ = 0.0;
  ContactSolver solver_;
};

}  // namespace topple::rigid
