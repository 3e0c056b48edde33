#include "model/rigid/plane_solver.h"

#include <algorithm>
#include <cmath>

#include "model/rigid/secant.h"

namespace topple::rigid {

namespace {

constexpr double kWorst = 0.7;         // From a good guess states that are wrong by this share of the worst change together.
constexpr int kNear = 1;               // That many bricks to each side.
constexpr int kJumps = 8;              // Of Newton's method before the states change one by one.
constexpr int kRounds = 6;             // Of the convex problem.
constexpr int kConvexIterations = 40;  // Of Newton's method in one round; it ends by itself.

inline void add_scaled(Column<3>& out, double scale, const Column<3>& force) {
  for (std::size_t i = 0; i < 3; ++i) out[i] += scale * force[i];
}

double sign_of(Grip grip) { return grip == Grip::forward ? 1.0 : -1.0; }

// Impulses that follow from how a point slips, the state that it should be in, and by how much the assumed one is wrong [m/s].
double settle(PlaneRow& row, const PlaneSlip& slip, PointState& should) {
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
  should = {pressed, idle ? Grip::stick : grip};
  double wrong = 0.0;
  if (pressed != row.state.pressed) wrong = pressed ? -slip.normal : 1000.0 * slip.normal;
  if (grip != row.state.grip && !idle) {
    wrong = std::max(
        wrong, row.state.grip == Grip::stick ? 1000.0 * (std::abs(sticking) - limit) / row.tangent_stiffness : std::abs(slip.tangent));
  }
  return wrong;
}

struct Impulse {
  double normal, tangent;
  PointState state;
};

// The same for the convex problem: the impulse is the point of the cone of friction nearest to that of two springs.
Impulse convex_impulse(const PlaneRow& row, const PlaneSlip& slip) {
  const double sticking = -row.tangent_stiffness * slip.tangent;
  const Grip grip = slip.tangent > 0.0 ? Grip::forward : Grip::backward;
  if (row.base > 0.0) {
    const bool pressed = slip.normal < 0.0;
    const double normal = pressed ? -row.normal_stiffness * slip.normal : 0.0;
    if (std::abs(sticking) <= row.lagged_limit) return {normal, sticking, {pressed, Grip::stick}};
    return {normal, -sign_of(grip) * row.lagged_limit, {pressed, grip}};
  }
  const double mu = row.friction, closing = -(slip.normal + mu * row.lagged_slip);
  if (mu * closing * row.normal_stiffness >= std::abs(sticking)) return {closing * row.normal_stiffness, sticking, {true, Grip::stick}};
  const double along_edge = closing + mu * std::abs(slip.tangent);
  if (along_edge <= 0.0) return {0.0, 0.0, {false, grip}};
  const double normal = along_edge * row.edge_stiffness;
  return {normal, -sign_of(grip) * mu * normal, {true, grip}};
}

bool settle_convexly(PlaneRow& row, const PlaneSlip& slip) {
  const Impulse impulse = convex_impulse(row, slip);
  const bool idle = !impulse.state.pressed && row.base == 0.0;
  const bool same = impulse.state.pressed == row.state.pressed && (impulse.state.grip == row.state.grip || idle);
  row.normal = impulse.normal;
  row.tangent = impulse.tangent;
  row.state = impulse.state;
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

// The system of equations that follows from the states that the rows assume.
void PlaneSolver::assemble(std::span<const PlaneUnknown> bodies, std::span<const PlaneRow> rows, Law law) {
  matrix_.clear();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const PlaneUnknown& body = bodies[i];
    matrix_.diagonal(i) = {{{body.mass}, {0.0, body.mass}, {0.0, 0.0, body.inertia}}};
    right_[i] = {body.mass * body.velocity.x, body.mass * body.velocity.z, body.inertia * body.velocity.turn};
  }
  kernels_.add_rows(rows.data(), rows.size(), law == Law::convex, matrix_.system(right_));
}

// Velocities that follow; bodies before `from` and all that touches them alone are as they were the last time.
bool PlaneSolver::solve_system(std::size_t from) {
  if (!matrix_.factorise(from)) return false;
  matrix_.solve(right_, from, velocity_);
  double sum = 0.0;
  for (const Column<3>& v : velocity_) sum += v[0] + v[1] + v[2];
  return std::isfinite(sum);
}

// Returns the first body whose equations have changed.
std::size_t PlaneSolver::change(PlaneRow& row, const PointState& state) {
  const PlaneSystem system = matrix_.system(right_);
  kernels_.add_row(row, false, -1.0, system);
  row.state = state;
  kernels_.add_row(row, false, 1.0, system);
  return static_cast<std::size_t>(row.b < 0 ? row.a : std::min(row.a, row.b));
}

// Impulses, and which states are wrong, and by how much; whether none is.
bool PlaneSolver::find_wrong(std::span<PlaneRow> rows) {
  std::fill(most_wrong_.begin(), most_wrong_.end(), 0.0);
  bool settled = true;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    wrong_[k] = settle(rows[k], slip_of(rows[k], velocity_), should_[k]);
    if (wrong_[k] == 0.0) continue;
    settled = false;
    for (const int body : {rows[k].a, rows[k].b}) {
      if (body >= 0) most_wrong_[static_cast<std::size_t>(body)] = std::max(most_wrong_[static_cast<std::size_t>(body)], wrong_[k]);
    }
  }
  return settled;
}

// Changes the states that are wrong by this share of the worst near them. Returns the first body whose equations have changed.
std::size_t PlaneSolver::change_wrong(std::span<PlaneRow> rows, double share) {
  const int count = static_cast<int>(most_wrong_.size());
  std::size_t from = most_wrong_.size();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (wrong_[k] == 0.0) continue;
    PlaneRow& row = rows[k];
    const int low = row.b < 0 ? row.a : std::min(row.a, row.b), high = std::max(row.a, row.b);
    double most = 0.0;
    for (int i = std::max(low - kNear, 0); i <= std::min(high + kNear, count - 1); ++i) {
      most = std::max(most, most_wrong_[static_cast<std::size_t>(i)]);
    }
    if (wrong_[k] >= share * most) from = std::min(from, change(row, should_[k]));
  }
  return from;
}

// With the true law, from the states that the rows hold: a few jumps of Newton's method, then one change after the other.
bool PlaneSolver::settle_truly(std::span<const PlaneUnknown> bodies, std::span<PlaneRow> rows, Guess guess) {
  should_.resize(rows.size());
  wrong_.resize(rows.size());
  most_wrong_.resize(bodies.size());
  assemble(bodies, rows, Law::true_law);
  std::size_t from = 0;
  for (int i = 1;; ++i) {
    if (!solve_system(from)) return false;
    if (find_wrong(rows)) return true;
    if (i == kJumps) break;
    from = change_wrong(rows, guess == Guess::good ? kWorst : 0.0);
  }
  if (!follow_path(rows)) return false;
  find_wrong(rows);
  return true;
}

void PlaneSolver::solve(std::span<PlaneUnknown> bodies, std::span<PlaneRow> rows, Guess guess) {
  velocity_.resize(bodies.size());
  right_.resize(bodies.size());
  shape(bodies.size(), rows);
  if (!settle_truly(bodies, rows, guess)) {
    for (std::size_t i = 0; i < bodies.size(); ++i) velocity_[i] = {bodies[i].guess.x, bodies[i].guess.z, bodies[i].guess.turn};
    for (PlaneRow& row : rows) {
      row.lagged_slip = std::abs(slip_of(row, velocity_).tangent);
      row.lagged_limit = row.friction * row.base;
      row.edge_stiffness = 1.0 / (1.0 / row.normal_stiffness + row.friction * row.friction / row.tangent_stiffness);
    }
    convex_ = velocity_;
    bool found = false;
    for (int round = 0; round < kRounds; ++round) {
      solve_convex(bodies, rows);
      convex_ = velocity_;
      kept_.assign(rows.begin(), rows.end());
      found = settle_truly(bodies, rows, Guess::good);
      if (found) break;
      std::copy(kept_.begin(), kept_.end(), rows.begin());
      velocity_ = convex_;
      for (PlaneRow& row : rows) {
        row.lagged_slip = row.state.pressed && row.state.grip != Grip::stick ? std::abs(slip_of(row, velocity_).tangent) : 0.0;
        row.lagged_limit = row.friction * (row.base + row.normal);
      }
    }
    if (!found) {
      // Where the true law has no solution, as on a floor of much friction [Painleve1895], points may part but not sink.
      for (PlaneRow& row : rows) row.lagged_slip = 0.0;
      solve_convex(bodies, rows);
    }
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i].velocity = {velocity_[i][0], velocity_[i][1], velocity_[i][2]};
}

// How far to go from `before_` along `change_`: where the cost is least, which is the kinetic energy of the change of velocity and what
// the springs store.
double PlaneSolver::best_share(std::span<const PlaneUnknown> bodies, std::span<const PlaneRow> rows) {
  double slope = 0.0, curvature = 0.0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const PlaneUnknown& body = bodies[i];
    const Column<3>& d = change_[i];
    slope += body.mass * ((before_[i][0] - body.velocity.x) * d[0] + (before_[i][1] - body.velocity.z) * d[1]) +
             body.inertia * (before_[i][2] - body.velocity.turn) * d[2];
    curvature += body.mass * (d[0] * d[0] + d[1] * d[1]) + body.inertia * d[2] * d[2];
  }
  ways_.clear();
  for (const PlaneRow& row : rows) {
    const PlaneSlip here = slip_of(row, before_), change = rate_of(row, change_);
    ways_.push_back({here.normal, here.tangent, change.normal, change.tangent});
  }
  const auto slope_at = [&](double share) {
    double sum = slope + share * curvature;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Way& way = ways_[i];
      const Impulse there = convex_impulse(rows[i], {way.normal + share * way.change_normal, way.tangent + share * way.change_tangent});
      sum -= there.normal * way.change_normal + there.tangent * way.change_tangent;
    }
    return sum;
  };
  // The slope never falls along the way.
  const double at_low = slope_at(0.0), at_high = slope_at(1.0);
  if (at_high <= 0.0 || at_low >= 0.0) return 1.0;
  const double enough = 1e-6 * std::abs(at_low);
  return zero_between(0.0, 1.0, at_low, at_high, 40, slope_at, [enough](double found) { return std::abs(found) <= enough; });
}

// One round, from the velocities as they are.
void PlaneSolver::solve_convex(std::span<const PlaneUnknown> bodies, std::span<PlaneRow> rows) {
  for (PlaneRow& row : rows) settle_convexly(row, slip_of(row, velocity_));
  for (int i = 0; i < kConvexIterations; ++i) {
    before_ = velocity_;
    assemble(bodies, rows, Law::convex);
    if (!solve_system(0)) {
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
