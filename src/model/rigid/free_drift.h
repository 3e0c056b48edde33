/// A drift of a front with six degrees of freedom: the time from one kick or blow to the next.
#pragma once

#include <span>
#include <vector>

#include "model/rigid/free_bricks.h"

namespace topple::rigid {

/// Bricks move by the velocities that Member::middle has for all of the drift, until a new point touches.
class FreeDrift {
 public:
  FreeDrift(const World& world, FreeBricks& bricks) : world_(world), bricks_(bricks) {}

  /// Tries one for which velocities are planned; it is cut short at its first impact, if impacts are `located`.
  void begin(double whole, bool located);
  double cut() const { return cut_; }  ///< How long it lasts [s].
  /// Bricks and touches become what they are at its end; adds the work of the forces [J]. Returns whether points have come to touch: they
  /// are fresh and take part from now on.
  bool end(double& work);

  struct Arrival {
    BrickId brick = kNoBrick;
    double time = 0.0;  ///< Since the drift began [s].
  };
  std::span<const Arrival> arrivals() const { return arrivals_; }  ///< Of the one that has ended.

 private:
  Body body_at(std::size_t place, double time) const;
  void find_next(const std::vector<Body>& bodies, Touch& touch) const;
  double recall_within(const Touch& touch) const;
  void try_to(double time);
  double farthest_passing() const;
  double first_impact(double time) const;
  double impact_of(const Touch& touch, const TouchPoint& point, double time) const;
  double distance_at(const Touch& touch, std::uint32_t feature, double time) const;
  double work_place(const ActiveForce& force) const;
  double move_bricks();
  void note_arrival(std::size_t place, double slope_before, double slope_after);
  void rein_in(double most);
  void accept(Touch& touch);
  bool activate_new_points();

  const World& world_;
  FreeBricks& bricks_;
  double whole_ = 0.0, cut_ = 0.0;
  bool idle_ = false;        // The last one was cut short by nothing.
  std::vector<Body> ahead_;  // The bodies at the end of what was tried.
  std::vector<Twist> found_;
  std::vector<Arrival> arrivals_;
  Touch before_;
};

}  // namespace topple::rigid
