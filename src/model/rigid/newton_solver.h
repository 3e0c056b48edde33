/// All contact points of a graph of bricks at once, where one after the other takes too long: stacks.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "model/rigid/block_cholesky.h"
#include "model/rigid/body_order.h"
#include "model/rigid/contact_row.h"

namespace topple::rigid {

/// One step of the augmented Lagrangian method [Alart1991]: with the multipliers (impulses) that the rows hold, the velocities are
/// found that minimise the energy of the change plus the penalties of all points, by Newton's method; then every row takes the impulse
/// that its penalty says. A tower of thirty layers needs one such step where Gauss-Seidel needs thousands of sweeps; sliding points
/// converge more slowly, so sweeps follow and have the last word.
class NewtonSolver {
 public:
  struct Effort {
    /// Of all points, as a multiple of their own masses: the higher, the nearer one step comes to the solution, the harder it is to find.
    /// The slowest way a tower of thirty layers can sway gives way some 10^3 times more easily than one point alone.
    double penalty = 1e4;
    double tolerance = 0.0;  ///< [m/s]
  };
  /// False, and nothing has changed, where no minimum was found: from farther off the penalties must be lower.
  bool improve(std::span<ContactRow> rows, std::span<Velocity> velocity, std::span<const Body> bodies, const BodyOrder& order,
               const Effort& effort);

 private:
  struct RowPart {
    double n = 0.0, s = 0.0, t = 0.0;         // trial impulses [N s]
    double penalty_n = 0.0, penalty_t = 0.0;  // impulse per velocity [kg]
    double radius = 0.0;                      // of the friction disk [N s]
    std::array<double, 4> stiffness{};        // of normal; along, both, across
  };
  void begin(std::span<const ContactRow> rows, std::span<const Velocity> velocity, std::span<const Body> bodies, const BodyOrder& order,
             double penalty);
  double find_step(std::span<const ContactRow> rows, std::span<const Body> bodies);
  bool limit_friction(std::span<const ContactRow> rows, double tolerance);
  void try_impulses(std::span<const ContactRow> rows, std::span<const double> velocity);
  void gradient(std::span<const ContactRow> rows, std::span<const double> velocity, std::span<double> out) const;
  void assemble(std::span<const ContactRow> rows);
  double slope(std::span<const ContactRow> rows, double share);
  double search(std::span<const ContactRow> rows);

  const BodyOrder* order_ = nullptr;
  std::vector<std::array<double, 10>> mass_;  // Of each number: mass, then the inertia's upper triangle by rows.
  std::vector<RowPart> parts_;
  std::vector<double> start_, velocity_, gradient_, step_, probe_;
  BlockCholesky matrix_;
};

}  // namespace topple::rigid
