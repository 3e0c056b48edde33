#include "model/rigid/newton_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/rigid/point_motion.h"

namespace topple::rigid {

namespace {

constexpr int kNewtonSteps = 40;
constexpr int kTrials = 40;           // Of the length of a step.
constexpr int kRounds = 8;            // In which the limits of friction follow the normal impulses.
constexpr double kSettled = 0.01;     // Of the tolerance: the last step.
constexpr double kBeyondLimit = 0.1;  // Of the tolerance: what friction may be beyond its limit.

constexpr std::size_t kWide = 6;  // Velocities of a brick.

std::array<double, 10> mass_matrix(const Body& body) {
  const Mat3 inertia = conjugated(body.axes, body.inertia);
  return {1.0 / body.inverse_mass, inertia.r0.x, inertia.r0.y, inertia.r0.z, inertia.r1.y, inertia.r1.z, inertia.r2.z};
}

// out = M v for one brick.
std::array<double, 6> times(const std::array<double, 10>& m, std::span<const double> v) {
  return {m[0] * v[0],
          m[0] * v[1],
          m[0] * v[2],
          m[1] * v[3] + m[2] * v[4] + m[3] * v[5],
          m[2] * v[3] + m[4] * v[4] + m[5] * v[5],
          m[3] * v[3] + m[5] * v[4] + m[6] * v[5]};
}

// What a row has of its bricks: 0 for a, 1 for b.
using Directions = double[3][12];

double product(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

std::span<const double> six(std::span<const double> all, int number) {
  return all.subspan(kWide * static_cast<std::size_t>(number), kWide);
}
std::span<double> six(std::span<double> all, int number) { return all.subspan(kWide * static_cast<std::size_t>(number), kWide); }

// Sum over one brick's side of a point.
void add_motion(const Directions& of, std::size_t brick, std::span<const double> v, Vec3& w) {
  for (std::size_t k = 0; k < kWide; ++k) {
    const std::size_t at = beside(brick, k);
    w.x += of[0][at] * v[k];
    w.y += of[1][at] * v[k];
    w.z += of[2][at] * v[k];
  }
}

// block += left^T D right of two bricks, D the point's 3 x 3 stiffness; the block's row is that of `left`.
void add_stiffness(const Directions& of, std::size_t left, std::size_t right, const std::array<double, 4>& d, Block6& block) {
  for (std::size_t c = 0; c < kWide; ++c) {
    const std::size_t column = beside(right, c);
    const double n = d[0] * of[0][column];
    const double s = d[1] * of[1][column] + d[2] * of[2][column];
    const double t = d[2] * of[1][column] + d[3] * of[2][column];
    for (std::size_t r = 0; r < kWide; ++r) {
      const std::size_t row = beside(left, r);
      block[kWide * c + r] += of[0][row] * n + of[1][row] * s + of[2][row] * t;
    }
  }
}

}  // namespace

void NewtonSolver::begin(std::span<const ContactRow> rows, std::span<const Velocity> velocity, std::span<const Body> bodies,
                         const BodyOrder& order, double penalty) {
  order_ = &order;
  mass_.clear();
  start_.clear();
  for (const int body : order.bodies()) {
    mass_.push_back(mass_matrix(bodies[static_cast<std::size_t>(body)]));
    const Velocity& v = velocity[static_cast<std::size_t>(body)];
    start_.insert(start_.end(), v.begin(), v.end());
  }
  velocity_ = start_;
  gradient_.resize(start_.size());
  step_.resize(start_.size());
  probe_.resize(start_.size());
  parts_.resize(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ContactRow& row = rows[i];
    RowPart& part = parts_[i];
    part.penalty_n = penalty / row.k_nn;
    part.penalty_t = penalty / std::max(row.k_aa, row.k_cc);
    part.radius = row.friction * (row.base + row.impulse[0]);
  }
}

// What each point's penalty says at these velocities; and how it answers to small changes of them.
void NewtonSolver::try_impulses(std::span<const ContactRow> rows, std::span<const double> velocity) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ContactRow& row = rows[i];
    RowPart& part = parts_[i];
    Vec3 w{row.bias[0], row.bias[1], row.bias[2]};
    const int a = order_->number(row.a), b = order_->number(row.b);
    if (a >= 0) add_motion(row.of, 0, six(velocity, a), w);
    if (b >= 0) add_motion(row.of, 1, six(velocity, b), w);
    const double n = row.impulse[0] - part.penalty_n * w.x;
    part.n = std::max(n, 0.0);
    part.stiffness = {n > 0.0 ? part.penalty_n : 0.0, part.penalty_t, 0.0, part.penalty_t};
    const double s = row.impulse[1] - part.penalty_t * w.y, t = row.impulse[2] - part.penalty_t * w.z;
    const double size = std::sqrt(s * s + t * t);
    part.s = s;
    part.t = t;
    if (size <= part.radius) continue;
    const double share = size > 0.0 ? part.radius / size : 0.0;
    part.s = share * s;
    part.t = share * t;
    const double ds = size > 0.0 ? s / size : 0.0, dt = size > 0.0 ? t / size : 0.0;
    const double across = share * part.penalty_t;
    part.stiffness[1] = across * (1.0 - ds * ds);
    part.stiffness[2] = -across * ds * dt;
    part.stiffness[3] = across * (1.0 - dt * dt);
  }
}

// M (v - start) - J^T (trial impulses - those that act already).
void NewtonSolver::gradient(std::span<const ContactRow> rows, std::span<const double> velocity, std::span<double> out) const {
  for (std::size_t i = 0; i < order_->bodies().size(); ++i) {
    std::array<double, 6> change{};
    for (std::size_t k = 0; k < kWide; ++k) change[k] = velocity[kWide * i + k] - start_[kWide * i + k];
    const std::array<double, 6> momentum = times(mass_[i], change);
    std::copy(momentum.begin(), momentum.end(), six(out, static_cast<int>(i)).begin());
  }
  const auto pull = [](const Directions& of, std::size_t brick, const Framed& impulse, std::span<double> g) {
    for (std::size_t k = 0; k < kWide; ++k) {
      const std::size_t at = beside(brick, k);
      g[k] -= of[0][at] * impulse[0] + of[1][at] * impulse[1] + of[2][at] * impulse[2];
    }
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ContactRow& row = rows[i];
    const RowPart& part = parts_[i];
    const Framed impulse{part.n - row.impulse[0], part.s - row.impulse[1], part.t - row.impulse[2]};
    const int a = order_->number(row.a), b = order_->number(row.b);
    if (a >= 0) pull(row.of, 0, impulse, six(out, a));
    if (b >= 0) pull(row.of, 1, impulse, six(out, b));
  }
}

void NewtonSolver::assemble(std::span<const ContactRow> rows) {
  matrix_.shape(order_->first());
  for (std::size_t i = 0; i < order_->bodies().size(); ++i) {
    const std::array<double, 10>& m = mass_[i];
    Block6& block = matrix_.at(static_cast<int>(i), static_cast<int>(i));
    block[0] = block[7] = block[14] = m[0];
    block[21] = m[1];
    block[22] = block[27] = m[2];
    block[23] = block[33] = m[3];
    block[28] = m[4];
    block[29] = block[34] = m[5];
    block[35] = m[6];
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ContactRow& row = rows[i];
    const RowPart& part = parts_[i];
    const int a = order_->number(row.a), b = order_->number(row.b);
    if (a >= 0) add_stiffness(row.of, 0, 0, part.stiffness, matrix_.at(a, a));
    if (b >= 0) add_stiffness(row.of, 1, 1, part.stiffness, matrix_.at(b, b));
    if (a >= 0 && b >= 0 && a > b) add_stiffness(row.of, 0, 1, part.stiffness, matrix_.at(a, b));
    if (a >= 0 && b >= 0 && b > a) add_stiffness(row.of, 1, 0, part.stiffness, matrix_.at(b, a));
  }
}

// Of the energy along the step, at this share of it.
double NewtonSolver::slope(std::span<const ContactRow> rows, double share) {
  for (std::size_t i = 0; i < probe_.size(); ++i) probe_[i] = velocity_[i] + share * step_[i];
  try_impulses(rows, probe_);
  gradient(rows, probe_, gradient_);
  return product(gradient_, step_);
}

// The share of the step at which the energy is least; it is convex, so its slope changes sign once.
double NewtonSolver::search(std::span<const ContactRow> rows) {
  double low = 0.0, high = 1.0;
  const double at_low = product(gradient_, step_);
  const double at_high = slope(rows, 1.0);
  constexpr double kFlat = 0.1;
  if (at_high <= kFlat * std::abs(at_low)) return 1.0;
  double share = 1.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    share = 0.5 * (low + high);
    const double here = slope(rows, share);
    if (std::abs(here) <= kFlat * std::abs(at_low)) break;
    (here < 0.0 ? low : high) = share;
  }
  return share;
}

// The step of least energy from here; returns how fast it moves the fastest corner [m/s], or a negative number if there is none.
double NewtonSolver::find_step(std::span<const ContactRow> rows, std::span<const Body> bodies) {
  try_impulses(rows, velocity_);
  gradient(rows, velocity_, gradient_);
  assemble(rows);
  if (!matrix_.factor()) return -1.0;
  for (std::size_t k = 0; k < step_.size(); ++k) step_[k] = -gradient_[k];
  matrix_.solve(step_);
  double largest = 0.0;
  for (std::size_t k = 0; k < order_->bodies().size(); ++k) {
    const double* v = &step_[kWide * k];
    const double radius = bodies[static_cast<std::size_t>(order_->bodies()[k])].radius;
    largest = std::max(largest, norm({v[0], v[1], v[2]}) + radius * norm({v[3], v[4], v[5]}));
  }
  return largest;
}

// Sets the limits of friction by the normal impulses found; returns whether some friction was beyond its own.
bool NewtonSolver::limit_friction(std::span<const ContactRow> rows, double tolerance) {
  try_impulses(rows, velocity_);
  bool beyond = false;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const ContactRow& row = rows[k];
    RowPart& part = parts_[k];
    const double s = part.s, t = part.t;
    part.radius = row.friction * (row.base + part.n);
    beyond = beyond || (std::sqrt(s * s + t * t) - part.radius) * row.k_aa > kBeyondLimit * tolerance;
  }
  return beyond;
}

bool NewtonSolver::improve(std::span<ContactRow> rows, std::span<Velocity> velocity, std::span<const Body> bodies, const BodyOrder& order,
                           const Effort& effort) {
  begin(rows, velocity, bodies, order, effort.penalty);
  bool settled = false;
  int rounds = 0;
  for (int i = 0; i < kNewtonSteps && !settled; ++i) {
    const double largest = find_step(rows, bodies);
    if (!(largest >= 0.0)) return false;
    settled = largest < kSettled * effort.tolerance;
    const double share = settled ? 1.0 : search(rows);
    for (std::size_t k = 0; k < step_.size(); ++k) velocity_[k] += share * step_[k];
    if (settled && rounds < kRounds && limit_friction(rows, effort.tolerance)) {
      settled = false;
      ++rounds;
    }
  }
  if (!settled) return false;
  try_impulses(rows, velocity_);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ContactRow& row = rows[i];
    const RowPart& part = parts_[i];
    const Framed change{part.n - row.impulse[0], part.s - row.impulse[1], part.t - row.impulse[2]};
    apply<2>(row, change.data(), velocity.front().data());
    row.impulse = {part.n, part.s, part.t};
  }
  return true;
}

}  // namespace topple::rigid
