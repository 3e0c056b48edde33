/// The specification of the contact solver: scalar, double precision, one contact point after the other, and all at once where that does
/// not settle.
#pragma once

#include <span>
#include <vector>

#include "model/rigid/contact_row.h"
#include "model/rigid/newton_solver.h"

namespace topple::rigid {

struct SolveLimits {
  double tolerance = 0.0;  ///< Sweeps end when no velocity changed by more than this [m/s].
  int sweeps = 0;          ///< Most sweeps.
  bool stacked = false;    ///< There are bricks on bricks: Newton's method helps where sweeps do not settle.
};

class ImpulseSolver {
 public:
  /// Gauss-Seidel from the impulses that the rows hold, forwards and backwards in turn; when it has not settled after a few sweeps,
  /// Newton's method between them. `bodies` come with the velocities that they would have without contact; afterwards they have their
  /// velocities and the rows their impulses. Returns by how much the last sweep changed a velocity [m/s].
  double solve(std::span<Body> bodies, std::span<ContactRow> rows, const SolveLimits& limits);

 private:
  void begin(std::span<Body> bodies, std::span<const ContactRow> rows);
  std::vector<SweepRow> rows_;
  BodyOrder order_;
  NewtonSolver newton_;
};

}  // namespace topple::rigid
