/// The specification of the contact solver: scalar, double precision, one contact point after the other, and all at once where that does
/// not settle.
#pragma once

#include <span>
#include <vector>

#include "model/rigid/contact_row.h"
#include "model/rigid/newton_solver.h"
#include "model/rigid/touch.h"

namespace topple::rigid {

struct SolveLimits {
  double tolerance = 0.0;  ///< Sweeps end when no velocity changed by more than this [m/s].
  int sweeps = 0;          ///< Most sweeps.
  bool stacked = false;    ///< There are bricks on bricks: Newton's method helps where sweeps do not settle.
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
  /// Gauss-Seidel, forwards and backwards in turn; when it has not settled after a few sweeps, Newton's method between them.
  void solve(std::span<Body> bodies, const SolveLimits& limits);
  /// Poisson's restitution [Glocker1995]: after the compression that solve() found, every point gives back the share `restitution` of its
  /// impulse. To be followed by solve(); returns false if there is nothing to give back.
  bool restore(std::span<const Touch> touches);

  std::span<ContactRow> rows() { return rows_; }
  std::span<const ContactRow> rows() const { return rows_; }

 private:
  void prepare(std::span<const Body> bodies, std::span<const Touch> touches);
  std::vector<ContactRow> rows_;
  NewtonSolver newton_;
};

}  // namespace topple::rigid
