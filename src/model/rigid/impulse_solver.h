/// The specification of the contact solver: scalar, double precision, one contact point after the other.
#pragma once

#include <span>
#include <vector>

#include "model/rigid/touch.h"

namespace topple::rigid {

/// One contact point, ready to be solved: velocities of the point in its own frame and what an impulse does to them.
struct ContactRow {
  int a = 0;
  int b = kFloor;
  int touch = 0;
  int point = 0;
  Vec3 arm_a, arm_b;           // From the centres of mass to the point [m].
  Vec3 normal, along, across;  // An orthonormal frame; the normal from b to a.
  double bias = 0.0;           // Added to the normal velocity before it is held at or above zero [m/s].
  double bias_along = 0.0, bias_across = 0.0;
  double k_nn = 0.0, k_na = 0.0, k_nc = 0.0, k_aa = 0.0, k_ac = 0.0, k_cc = 0.0;  // Velocity per impulse [1/kg].
  double friction = 0.0;
  double floor_impulse = 0.0;           // The normal impulse is at least this [N s].
  double n = 0.0, s = 0.0, t = 0.0;     // Impulses so far: normal, along, across [N s].
  double n0 = 0.0, s0 = 0.0, t0 = 0.0;  // Of the first half step: counted for the limits, not applied again [N s].
};

struct SolveLimits {
  double tolerance = 0.0;  ///< Sweeps end when no velocity changed by more than this [m/s].
  int sweeps = 0;          ///< Most sweeps.
};

class ImpulseSolver {
 public:
  /// The half step before the bodies drift for `time`: after it no active point will be closer than touching.
  void prepare_positions(std::span<const Body> bodies, std::span<const Touch> touches, double time, double full_step);
  /// The half step after it: no active point approaches. Counts the impulses of the first half for the limits.
  void prepare_velocities(std::span<const Body> bodies, std::span<const Touch> touches, double full_step);
  /// The first guess, `time` times the forces of the last step: not applied yet.
  void guess(std::span<const Touch> touches, double time);
  /// Applies the impulses that the rows hold.
  void apply_guess(std::span<Body> bodies);
  /// Gauss-Seidel, forwards and backwards in turn.
  void solve(std::span<Body> bodies, const SolveLimits& limits);
  /// Poisson's restitution [Glocker1995]: after the compression that solve() found, every point gives back the share `restitution` of its
  /// impulse. To be followed by solve(); returns false if there is nothing to give back.
  bool restore(std::span<const Touch> touches);

  std::span<ContactRow> rows() { return rows_; }
  std::span<const ContactRow> rows() const { return rows_; }

 private:
  void prepare(std::span<const Body> bodies, std::span<const Touch> touches);
  std::vector<ContactRow> rows_;
};

}  // namespace topple::rigid
