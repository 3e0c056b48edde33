#include "model/rigid/contact_solver.h"

#include <algorithm>

namespace topple::rigid {

namespace {

// Along a wave: so many sweeps, then at most so many systems of equations, so many times over.
constexpr int kSweeps = 4;
constexpr int kSystems = 12;
constexpr int kRounds = 4;
constexpr int kConeSweeps = 2;  // For each that there were before.
// In a stack, which settles brick by brick when it is put down: so many systems, and so many more a body.
constexpr int kStackSystems = 20;
constexpr int kPerBody = 2;
// After so many sweeps of a stack the augmented Lagrangian comes between them.
constexpr int kSweepsAlone = 24;

Velocity velocity_of(const Vec3& linear, const Vec3& spin) { return {linear.x, linear.y, linear.z, spin.x, spin.y, spin.z}; }

}  // namespace

void ContactSolver::solve(std::span<Body> bodies, std::span<ContactRow> rows, std::span<const Twist> guess, const SolveLimits& limits) {
  free_.clear();
  for (const Body& body : bodies) free_.push_back(velocity_of(body.velocity, body.angular_velocity));
  velocity_ = free_;
  chain_.begin(rows, bodies);
  if (limits.stacked) {
    if (!solve_stack(rows, guess, limits)) sweep_stack(rows, bodies, limits);
  } else if (!solve_wave(rows, limits)) {
    const double change = sweep(rows, limits.sweeps, limits.tolerance);
    if (change > limits.lost) sweep_cones(rows, limits);
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Velocity& v = velocity_[i];
    bodies[i].velocity = {v[0], v[1], v[2]};
    bodies[i].angular_velocity = {v[3], v[4], v[5]};
  }
}

// Sweeps from the impulses that the rows hold; returns the largest change of the last one.
double ContactSolver::sweep(std::span<ContactRow> rows, int most, double tolerance) {
  sweeps_.begin(rows, free_);
  const double change = sweeps_.run(rows, most, tolerance);
  Sweeps::tell_states(rows);
  velocity_ = sweeps_.velocity;
  return change;
}

// Where nothing else settles, and perhaps there is no solution: bricks must not go through each other, nor make energy.
void ContactSolver::sweep_cones(std::span<ContactRow> rows, const SolveLimits& limits) {
  for (ContactRow& row : rows) row.impulse = {};
  sweeps_.begin(rows, free_);
  sweeps_.run_cones(rows, kConeSweeps * limits.sweeps, limits.tolerance);
  Sweeps::tell_states(rows);
  velocity_ = sweeps_.velocity;
}

bool ContactSolver::solve_wave(std::span<ContactRow> rows, const SolveLimits& limits) {
  for (int round = 0; round < kRounds; ++round) {
    sweep(rows, kSweeps, limits.tolerance);
    velocity_ = free_;
    if (chain_.solve(rows, sweeps_.velocity, limits.tolerance, kSystems, velocity_)) return true;
  }
  return false;
}

bool ContactSolver::solve_stack(std::span<ContactRow> rows, std::span<const Twist> guess, const SolveLimits& limits) {
  guess_.clear();
  for (const Twist& twist : guess) guess_.push_back(velocity_of(twist.velocity, twist.spin));
  const int most = kStackSystems + kPerBody * static_cast<int>(chain_.body_count());
  return chain_.solve(rows, guess_, limits.tolerance, most, velocity_);
}

double ContactSolver::sweep_stack(std::span<ContactRow> rows, std::span<const Body> bodies, const SolveLimits& limits) {
  constexpr double kLeastPenalty = 1.0, kFirstPenalty = 1e4, kMostPenalty = 1e5;
  NewtonSolver::Effort effort{kFirstPenalty, limits.tolerance};
  sweeps_.begin(rows, free_);
  double change = 0.0;
  for (int sweeps = 0; sweeps < limits.sweeps; ++sweeps) {
    change = sweeps_.run(rows, 1, limits.tolerance);
    if (change <= limits.tolerance) break;
    if (sweeps < kSweepsAlone) continue;
    const bool found = newton_.improve(rows, sweeps_.velocity, bodies, chain_.order(), effort);
    effort.penalty = found ? std::min(10.0 * effort.penalty, kMostPenalty) : std::max(0.1 * effort.penalty, kLeastPenalty);
  }
  Sweeps::tell_states(rows);
  velocity_ = sweeps_.velocity;
  return change;
}

}  // namespace topple::rigid
