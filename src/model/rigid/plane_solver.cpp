#include "model/rigid/plane_solver.h"

#include <algorithm>
#include <cmath>

namespace topple::rigid {

namespace {

constexpr int kTrueIterations = 4;     // Of Newton's method with the true law before the convex problem is asked for the states.
constexpr int kRounds = 6;             // Of the convex problem.
constexpr int kConvexIterations = 40;  // Of Newton's method in one round; it ends by itself.

double dot(const Column<3>& a, const Column<3>& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

void add_outer(Block<3>& out, double scale, const Column<3>& force, const Column<3>& rate) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = scale * force[i];
    for (std::size_t j = 0; j < 3; ++j) out.m[3 * i + j] += value * rate[j];
  }
}

void add_scaled(Column<3>& out, double scale, const Column<3>& force) {
  for (std::size_t i = 0; i < 3; ++i) out[i] += scale * force[i];
}

struct Slip {
  double normal, tangent;
};

Slip rate_of(const PlaneRow& row, std::span<const Column<3>> velocity) {
  const Column<3>& a = velocity[static_cast<std::size_t>(row.a)];
  Slip slip{dot(row.normal_a, a), dot(row.tangent_a, a)};
  if (row.b >= 0) {
    const Column<3>& b = velocity[static_cast<std::size_t>(row.b)];
    slip.normal += dot(row.normal_b, b);
    slip.tangent += dot(row.tangent_b, b);
  }
  return slip;
}

Slip slip_of(const PlaneRow& row, std::span<const Column<3>> velocity) {
  const Slip rate = rate_of(row, velocity);
  return {row.bias + rate.normal, row.tangent_bias + rate.tangent};
}

double sign_of(Grip grip) { return grip == Grip::forward ? 1.0 : -1.0; }

// Impulses and states that follow from how a point slips. Returns whether the states are those that were assumed.
bool settle(PlaneRow& row, const Slip& slip) {
  const bool pressed = slip.normal < 0.0;
  row.normal = pressed ? -row.normal_stiffness * slip.normal : 0.0;
  const double limit = row.friction * (row.base + row.normal);
  const double sticking = -row.tangent_stiffness * slip.tangent;
  Grip grip = Grip::stick;
  if (std::abs(sticking) > limit) {
    grip = slip.tangent > 0.0 ? Grip::forward : Grip::backward;
    // From sliding one way to sliding the other by way of sticking, or it might go on for ever.
    if (row.state.grip != Grip::stick && row.state.grip != grip) grip = Grip::stick;
  }
  row.tangent = grip == Grip::stick ? std::clamp(sticking, -limit, limit) : -sign_of(grip) * limit;
  const bool idle = !pressed && row.base == 0.0;
  const bool same = pressed == row.state.pressed && (grip == row.state.grip || idle);
  row.state.pressed = pressed;
  row.state.grip = idle ? Grip::stick : grip;
  return same;
}

// The same for the convex problem: the impulse is the point of the cone of friction nearest to that of two springs.
bool settle_convexly(PlaneRow& row, const Slip& slip) {
  const double sticking = -row.tangent_stiffness * slip.tangent;
  bool pressed = slip.normal < 0.0;
  Grip grip = slip.tangent > 0.0 ? Grip::forward : Grip::backward;
  if (row.base > 0.0) {
    row.normal = pressed ? -row.normal_stiffness * slip.normal : 0.0;
    if (std::abs(sticking) <= row.lagged_limit) grip = Grip::stick;
    row.tangent = std::clamp(sticking, -row.lagged_limit, row.lagged_limit);
  } else {
    const double mu = row.friction, closing = -(slip.normal + mu * row.lagged_slip);
    const double springs = 1.0 / row.normal_stiffness + mu * mu / row.tangent_stiffness;
    const double along_edge = (closing + mu * std::abs(slip.tangent)) / springs;
    if (mu * closing * row.normal_stiffness >= std::abs(sticking)) {
      pressed = true;
      grip = Grip::stick;
      row.normal = closing * row.normal_stiffness;
      row.tangent = sticking;
    } else {
      pressed = along_edge > 0.0;
      row.normal = std::max(along_edge, 0.0);
      row.tangent = -sign_of(grip) * mu * row.normal;
    }
  }
  const bool idle = !pressed && row.base == 0.0;
  const bool same = pressed == row.state.pressed && (grip == row.state.grip || idle);
  row.state.pressed = pressed;
  row.state.grip = grip;
  return same;
}

}  // namespace

void PlaneSolver::shape(std::size_t count, std::span<const PlaneRow> rows) {
  first_.resize(count);
  for (std::size_t i = 0; i < count; ++i) first_[i] = static_cast<int>(i);
  for (const PlaneRow& row : rows) {
    if (row.b < 0) continue;
    int& first = first_[static_cast<std::size_t>(std::max(row.a, row.b))];
    first = std::min(first, std::min(row.a, row.b));
  }
  matrix_.shape(first_);
}

// Adds force (rate . v) to the matrix: `force` is what the point does to its bodies per impulse, `rate` gives the velocity.
void PlaneSolver::add(const PlaneRow& row, const Column<3>& force_a, const Column<3>& force_b, const Column<3>& rate_a,
                      const Column<3>& rate_b, double stiffness) {
  const auto a = static_cast<std::size_t>(row.a);
  add_outer(matrix_.diagonal(a), stiffness, force_a, rate_a);
  if (row.b < 0) return;
  const auto b = static_cast<std::size_t>(row.b);
  add_outer(matrix_.diagonal(b), stiffness, force_b, rate_b);
  add_outer(a < b ? matrix_.upper(a, b) : matrix_.lower(a, b), stiffness, force_a, rate_b);
  add_outer(a < b ? matrix_.lower(b, a) : matrix_.upper(b, a), stiffness, force_b, rate_a);
}

void PlaneSolver::push(const PlaneRow& row, double impulse, const Column<3>& on_a, const Column<3>& on_b) {
  add_scaled(velocity_[static_cast<std::size_t>(row.a)], impulse, on_a);
  if (row.b >= 0) add_scaled(velocity_[static_cast<std::size_t>(row.b)], impulse, on_b);
}

// Velocities that follow from the states that the rows assume.
bool PlaneSolver::solve_states(std::span<const PlaneUnknown> bodies, std::span<const PlaneRow> rows, Law law) {
  shape(bodies.size(), rows);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const PlaneUnknown& body = bodies[i];
    matrix_.diagonal(i).m = {body.mass, 0.0, 0.0, 0.0, body.mass, 0.0, 0.0, 0.0, body.inertia};
    velocity_[i] = {body.mass * body.velocity.x, body.mass * body.velocity.z, body.inertia * body.velocity.turn};
  }
  for (const PlaneRow& row : rows) {
    const bool convex = law == Law::convex;
    const bool on_cone = convex && row.base == 0.0;
    if (!row.state.pressed && row.base == 0.0) continue;
    Column<3> force_a = row.normal_a, force_b = row.normal_b;
    double bias = row.bias + (on_cone ? row.friction * row.lagged_slip : 0.0);
    if (row.state.grip == Grip::stick) {
      add(row, row.tangent_a, row.tangent_b, row.tangent_a, row.tangent_b, row.tangent_stiffness);
      push(row, -row.tangent_stiffness * row.tangent_bias, row.tangent_a, row.tangent_b);
    } else {
      // Sliding friction follows the normal impulse.
      const double share = -sign_of(row.state.grip) * row.friction;
      if (convex && !on_cone) {
        push(row, -sign_of(row.state.grip) * row.lagged_limit, row.tangent_a, row.tangent_b);
      } else {
        add_scaled(force_a, share, row.tangent_a);
        add_scaled(force_b, share, row.tangent_b);
        if (row.base > 0.0) push(row, share * row.base, row.tangent_a, row.tangent_b);
      }
      if (on_cone) {
        const double stiffness = 1.0 / (1.0 / row.normal_stiffness + row.friction * row.friction / row.tangent_stiffness);
        add(row, force_a, force_b, force_a, force_b, stiffness);
        push(row, -stiffness * (bias + share * row.tangent_bias), force_a, force_b);
        continue;
      }
    }
    if (!row.state.pressed) continue;
    add(row, force_a, force_b, row.normal_a, row.normal_b, row.normal_stiffness);
    push(row, -row.normal_stiffness * bias, force_a, force_b);
  }
  if (!matrix_.factorise()) return false;
  matrix_.solve(velocity_);
  double sum = 0.0;
  for (const Column<3>& v : velocity_) sum += v[0] + v[1] + v[2];
  return std::isfinite(sum);
}

// Newton's method with the true law from the states that the rows hold.
bool PlaneSolver::settle_truly(std::span<const PlaneUnknown> bodies, std::span<PlaneRow> rows) {
  for (int i = 0; i < kTrueIterations; ++i) {
    if (!solve_states(bodies, rows, Law::true_law)) return false;
    bool settled = true;
    for (PlaneRow& row : rows) settled = settle(row, slip_of(row, velocity_)) && settled;
    if (settled) return true;
  }
  return false;
}

void PlaneSolver::solve(std::span<PlaneUnknown> bodies, std::span<PlaneRow> rows) {
  velocity_.resize(bodies.size());
  if (!settle_truly(bodies, rows)) {
    for (std::size_t i = 0; i < bodies.size(); ++i) velocity_[i] = {bodies[i].guess.x, bodies[i].guess.z, bodies[i].guess.turn};
    for (PlaneRow& row : rows) {
      row.lagged_slip = std::abs(slip_of(row, velocity_).tangent);
      row.lagged_limit = row.friction * row.base;
    }
    convex_ = velocity_;
    for (int round = 0; round < kRounds; ++round) {
      solve_convex(bodies, rows);
      convex_ = velocity_;
      kept_.assign(rows.begin(), rows.end());
      if (settle_truly(bodies, rows)) break;
      std::copy(kept_.begin(), kept_.end(), rows.begin());
      velocity_ = convex_;
      for (PlaneRow& row : rows) {
        row.lagged_slip = row.state.pressed && row.state.grip != Grip::stick ? std::abs(slip_of(row, velocity_).tangent) : 0.0;
        row.lagged_limit = row.friction * (row.base + row.normal);
      }
    }
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i].velocity = {velocity_[i][0], velocity_[i][1], velocity_[i][2]};
}

// How far to go from `before_` along `change_`: where the cost is least, which is the kinetic energy of the change of velocity and what
// the springs store.
double PlaneSolver::best_share(std::span<const PlaneUnknown> bodies, std::span<PlaneRow> rows) const {
  double slope = 0.0, curvature = 0.0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const PlaneUnknown& body = bodies[i];
    const Column<3>& d = change_[i];
    slope += body.mass * ((before_[i][0] - body.velocity.x) * d[0] + (before_[i][1] - body.velocity.z) * d[1]) +
             body.inertia * (before_[i][2] - body.velocity.turn) * d[2];
    curvature += body.mass * (d[0] * d[0] + d[1] * d[1]) + body.inertia * d[2] * d[2];
  }
  for (PlaneRow& row : rows) {
    const Slip here = slip_of(row, before_), change = rate_of(row, change_);
    row.slip_normal = here.normal;
    row.slip_tangent = here.tangent;
    row.change_normal = change.normal;
    row.change_tangent = change.tangent;
  }
  const auto slope_at = [&](double share) {
    double sum = slope + share * curvature;
    for (const PlaneRow& row : rows) {
      PlaneRow there = row;
      settle_convexly(there, {row.slip_normal + share * row.change_normal, row.slip_tangent + share * row.change_tangent});
      sum -= there.normal * row.change_normal + there.tangent * row.change_tangent;
    }
    return sum;
  };
  if (slope_at(1.0) <= 0.0) return 1.0;
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    (slope_at(middle) > 0.0 ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

// One round, from the velocities as they are.
void PlaneSolver::solve_convex(std::span<const PlaneUnknown> bodies, std::span<PlaneRow> rows) {
  for (PlaneRow& row : rows) settle_convexly(row, slip_of(row, velocity_));
  for (int i = 0; i < kConvexIterations; ++i) {
    before_ = velocity_;
    if (!solve_states(bodies, rows, Law::convex)) {
      velocity_ = before_;
      return;
    }
    bool settled = true;
    for (PlaneRow& row : rows) settled = settle_convexly(row, slip_of(row, velocity_)) && settled;
    if (settled) return;
    change_ = velocity_;
    for (std::size_t k = 0; k < bodies.size(); ++k) add_scaled(change_[k], -1.0, before_[k]);
    const double share = best_share(bodies, rows);
    if (share == 1.0) continue;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      velocity_[k] = before_[k];
      add_scaled(velocity_[k], share, change_[k]);
    }
    for (PlaneRow& row : rows) settle_convexly(row, slip_of(row, velocity_));
  }
}

}  // namespace topple::rigid
