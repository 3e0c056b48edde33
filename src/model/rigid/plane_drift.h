/// A drift of a plane front: the time from one kick or blow to the next.
#pragma once

#include <algorithm>
#include <cstdint>

#include "model/rigid/plane_bricks.h"

namespace topple::rigid {

/// Bricks move by PlaneBrick::velocity and with the acceleration that takes its mean over the whole drift to PlaneBrick::middle, until a
/// new point touches or all of the drift is over: mostly in another step than it began. Until then the chain is as it was when it began.
class PlaneDrift {
 public:
  PlaneDrift(const World& world, PlaneChain& chain) : world_(world), chain_(chain) {}

  bool is_under_way() const { return under_way_; }
  double whole() const { return whole_; }  ///< As it is planned [s],
  double cut() const { return cut_; }      ///< up to the first impact [s],
  double done() const { return done_; }    ///< and as far as the step has come in it [s].

  /// Begins one for which velocities are planned; it is cut short at its first impact, if impacts are `located`.
  void begin(double whole, bool located);
  /// Takes up one that was computed before: the chain has no part in it.
  void follow(double whole, double cut);
  /// The step has come so far in it, if it lasts so long [s].
  void go_to(double time) { done_ = std::min(time, cut_); }
  /// Ends it after `time` of it [s], with the chain as it is then; adds the work of the forces [J]. Returns whether points have come to
  /// touch: they are fresh and take part from now on.
  bool end(double time, double& work);
  /// Ends it where the chain has no part in it.
  void leave() {
    under_way_ = false;
    done_ = 0.0;
  }

  // As it is by now, amid the drift.
  PlaneBrick by_now(const PlaneBrick& brick) const;
  PlaneManifold by_now(const PlaneTouch& touch) const;

 private:
  PlaneBox box_at(const PlaneBrick& brick, double time) const;
  void test_next(PlaneTouch& touch, const PlaneBox& a, const PlaneBox& b) const;
  void try_to(double time);
  double find_cut();
  double first_impact(double time) const;
  double impact_of(const PlaneTouch& touch, const PlanePoint& point, double time) const;
  double distance_at(const PlaneTouch& touch, std::uint8_t feature, double time) const;
  double work_place(const PlaneForce& force) const;
  void move_bricks(double time);
  bool activate_new_points();

  const World& world_;
  PlaneChain& chain_;
  bool under_way_ = false;
  double whole_ = 0.0, cut_ = 0.0, done_ = 0.0;
  double passing_ = 0.0;  // How far two go past each other that are apart and may have met in what was tried, at most [thicknesses].
};

}  // namespace topple::rigid
