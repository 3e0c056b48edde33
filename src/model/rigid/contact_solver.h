/// All contacts of a front at one moment: which impulses act, and how fast bricks move then.
#pragma once

#include <span>
#include <vector>

#include "model/rigid/chain_solver.h"
#include "model/rigid/newton_solver.h"
#include "model/rigid/sweeps.h"

namespace topple::rigid {

/// Velocities of a body.
struct Twist {
  Vec3 velocity;  ///< [m/s]
  Vec3 spin;      ///< World axes [rad/s].
};

inline Twist twist_of(const Body& body) { return {body.velocity, body.angular_velocity}; }
inline void set_twist(Body& body, const Twist& twist) {
  body.velocity = twist.velocity;
  body.angular_velocity = twist.spin;
}

struct SolveLimits {
  double tolerance = 0.0;  ///< Of velocities [m/s].
  int sweeps = 0;          ///< Most sweeps, where Newton's method fails.
  double lost = 0.0;       ///< Sweeps that end with larger changes have lost their way [m/s].
  bool stacked = false;    ///< Bricks stand on bricks: what they carry comes from far below.
};

/// Sweeps find out, from what was so in the last solution, which points press and slide; Newton's method then solves for all at once, and
/// if it finds other states than it began with, tries those. Where it does not settle, the sweeps have another go; if they lose their way,
/// sweeps with another law of friction that always has a solution have the last word. In stacks the augmented Lagrangian helps them.
class ContactSolver {
 public:
  explicit ContactSolver(const LaneKernels& kernels) : chain_(kernels), sweeps_(kernels) {}
  /// `bodies` come with the velocities that they would have without contact, rows with what they carried and did the last time; `guess` is
  /// near what velocities will be. Afterwards bodies have their velocities and rows their impulses.
  void solve(std::span<Body> bodies, std::span<ContactRow> rows, std::span<const Twist> guess, const SolveLimits& limits);

 private:
  double sweep(std::span<ContactRow> rows, int most, double tolerance);
  bool solve_wave(std::span<ContactRow> rows, const SolveLimits& limits);
  bool solve_stack(std::span<ContactRow> rows, std::span<const Twist> guess, const SolveLimits& limits);
  double sweep_stack(std::span<ContactRow> rows, std::span<const Body> bodies, const SolveLimits& limits);
  void sweep_cones(std::span<ContactRow> rows, const SolveLimits& limits);

  std::vector<Velocity> free_, velocity_, guess_;
  ChainSolver chain_;
  Sweeps sweeps_;
  NewtonSolver newton_;
};

}  // namespace topple::rigid
