#include "model/hinge/leg.h"

#include <algorithm>
#include <cmath>

namespace topple::hinge {

namespace {

// ---- In angle: E = rate^2 obeys the linear equation dE/dth = 2 (torque - coupling E) / inertia ----

// Lobatto's five points on [0, 1] and the integrals from 0 to each of them of the polynomial through five values (Lobatto IIIA, order 8)
//:
// the integrals of the Lagrange polynomials of those points.
constexpr double kNode = 0.32732683535398857;  // sqrt(3/7) / 2
constexpr std::array<double, 5> kNodes = {0.0, 0.5 - kNode, 0.5, 0.5 + kNode, 1.0};
using Weights = std::array<std::array<double, 5>, 5>;

constexpr Weights integrals() {
  Weights weights{};
  for (std::size_t j = 0; j < 5; ++j) {
    std::array<double, 6> polynomial{1.0};  // Coefficients of the Lagrange polynomial of node j, lowest first.
    std::size_t degree = 0;
    double scale = 1.0;
    for (std::size_t k = 0; k < 5; ++k) {
      if (k == j) continue;
      for (std::size_t i = degree + 2; i-- > 0;) {
        polynomial[i] = (i > 0 ? polynomial[i - 1] : 0.0) - kNodes[k] * (i <= degree ? polynomial[i] : 0.0);
      }
      ++degree;
      scale *= kNodes[j] - kNodes[k];
    }
    for (std::size_t i = 0; i < 5; ++i) {
      double sum = 0.0;
      double power = kNodes[i];
      for (std::size_t n = 0; n < 5; ++n) {
        sum += polynomial[n] * power / static_cast<double>(n + 1);
        power *= kNodes[i];
      }
      weights[i][j] = sum / scale;
    }
  }
  return weights;
}
constexpr Weights kIntegral = integrals();

constexpr std::array<double, 5> scales() {
  std::array<double, 5> scale{};
  for (std::size_t j = 0; j < 5; ++j) {
    double product = 1.0;
    for (std::size_t k = 0; k < 5; ++k) product *= k == j ? 1.0 : kNodes[j] - kNodes[k];
    scale[j] = 1.0 / product;
  }
  return scale;
}
constexpr std::array<double, 5> kScale = scales();

// How far the times by Simpson's rule and by Lobatto's five points may differ, as a fraction of the leg. The difference is the error of
// the fourth order; that of the eighth is far smaller: 3e-7 (measured in tests/model/hinge_leg_test.cpp).
constexpr double kSmooth = 3e-4;
constexpr int kMostHalvings = 3;

// Newton's steps to the time of an angle end once one is this small, as a fraction of the way between two nodes: the next is its square.
constexpr double kSettled = 1e-8;

// Gauss without pivoting: the matrix is the identity plus integrals over a short leg.
bool solve(std::array<std::array<double, 5>, 4>& rows, std::array<double, 5>& out) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(std::fabs(rows[i][i]) > 1e-3)) return false;
    for (std::size_t j = i + 1; j < 4; ++j) {
      const double factor = rows[j][i] / rows[i][i];
      for (std::size_t k = i; k < 5; ++k) rows[j][k] -= factor * rows[i][k];
    }
  }
  for (std::size_t i = 4; i-- > 0;) {
    double sum = rows[i][4];
    for (std::size_t k = i + 1; k < 4; ++k) sum -= rows[i][k] * out[k + 1];
    out[i + 1] = sum / rows[i][i];
  }
  return true;
}

// One step over `span` [rad], which has the sign of the direction. No leg (count 0) if the time is not smooth over it.
Leg collocate(Train& train, const FrontState& start, double span, const LegGoal& goal) {
  const double direction = goal.direction;
  std::array<double, 4> angles;
  for (std::size_t i = 0; i < 4; ++i) angles[i] = start.angle + kNodes[i + 1] * span;
  const Sweep sweep = train.sweep(angles, direction, goal.slack);
  const std::array<FrontView, 5> views = {goal.start, sweep.views[0], sweep.views[1], sweep.views[2], sweep.views[3]};
  Leg leg;
  leg.turns_over = sweep.turns_over;
  leg.touches = sweep.touches;
  leg.goal_view = sweep.views[3];
  std::array<double, 5> energy{start.rate * start.rate};
  std::array<std::array<double, 5>, 4> rows;
  for (std::size_t i = 1; i < 5; ++i) {
    double known = energy[0] * (1.0 - span * kIntegral[i][0] * 2.0 * views[0].coupling / views[0].inertia);
    for (std::size_t j = 0; j < 5; ++j) known += span * kIntegral[i][j] * 2.0 * views[j].torque / views[j].inertia;
    for (std::size_t j = 1; j < 5; ++j) {
      rows[i - 1][j - 1] = (i == j ? 1.0 : 0.0) + span * kIntegral[i][j] * 2.0 * views[j].coupling / views[j].inertia;
    }
    rows[i - 1][4] = known;
  }
  if (!solve(rows, energy)) return leg;
  std::array<double, 5> slowness;
  for (std::size_t i = 0; i < 5; ++i) {
    if (!(energy[i] > 0.0) || !(views[i].inertia > 0.0)) return leg;
    slowness[i] = direction / std::sqrt(energy[i]);
  }
  for (std::size_t i = 0; i < 5; ++i) {
    double time = 0.0;
    for (std::size_t j = 0; j < 5; ++j) time += kIntegral[i][j] * slowness[j];
    leg.nodes[i] = {start.time + span * time, start.angle + kNodes[i] * span, 1.0 / slowness[i],
                    (views[i].torque - views[i].coupling * energy[i]) / views[i].inertia};
  }
  leg.nodes[0] = {start.time, start.angle, start.rate, leg.nodes[0].acceleration};
  const double simpson = span * (slowness[0] + 4.0 * slowness[2] + slowness[4]) / 6.0;
  const double lobatto = leg.nodes[4].time - start.time;
  if (!(std::fabs(simpson - lobatto) <= kSmooth * lobatto)) return leg;
  leg.count = 5;
  return leg;
}

// ---- In time: Runge and Kutta's fourth order ----

FrontState runge_kutta(const Train& train, const FrontState& from, double direction, double step) {
  const auto slope = [&](double angle, double rate) { return train.view(angle, direction).acceleration(rate); };
  const double a1 = slope(from.angle, from.rate);
  const double w2 = from.rate + 0.5 * step * a1;
  const double a2 = slope(from.angle + 0.5 * step * from.rate, w2);
  const double w3 = from.rate + 0.5 * step * a2;
  const double a3 = slope(from.angle + 0.5 * step * w2, w3);
  const double w4 = from.rate + step * a3;
  const double a4 = slope(from.angle + step * w3, w4);
  FrontState to;
  to.time = from.time + step;
  to.angle = from.angle + step / 6.0 * (from.rate + 2.0 * w2 + 2.0 * w3 + w4);
  to.rate = from.rate + step / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  to.acceleration = slope(to.angle, to.rate);
  return to;
}

// The polynomial through the squares of the rates at the five points, at a fraction of the leg's way.
double energy_at(const std::array<FrontState, 5>& nodes, double fraction) {
  double energy = 0.0;
  for (std::size_t j = 0; j < 5; ++j) {
    double term = kScale[j] * nodes[j].rate * nodes[j].rate;
    for (std::size_t k = 0; k < 5; ++k) {
      if (k != j) term *= fraction - kNodes[k];
    }
    energy += term;
  }
  return energy;
}

// The quintic through angle, rate and acceleration of two nodes: the sum of c_n x^n with x from 0 to 1 between them; the last three
// coefficients fulfil angle, rate and acceleration at the end.
struct Between {
  Between(const FrontState& a, const FrontState& b) : start(a.time), span(b.time - a.time), c0(a.angle) {
    c1 = a.rate * span;
    c2 = 0.5 * a.acceleration * span * span;
    const double angle = b.angle - (a.angle + c1 + c2);
    const double rate = b.rate * span - (c1 + 2.0 * c2);
    const double bend = b.acceleration * span * span - 2.0 * c2;
    c3 = 10.0 * angle - 4.0 * rate + 0.5 * bend;
    c4 = -15.0 * angle + 7.0 * rate - bend;
    c5 = 6.0 * angle - 3.0 * rate + 0.5 * bend;
  }
  double at(double time) const { return span > 0.0 ? (time - start) / span : 0.0; }
  double angle(double x) const { return c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * c5)))); }
  double slope(double x) const { return c1 + x * (2.0 * c2 + x * (3.0 * c3 + x * (4.0 * c4 + x * 5.0 * c5))); }
  double bend(double x) const { return 2.0 * c2 + x * (6.0 * c3 + x * (12.0 * c4 + x * 20.0 * c5)); }
  FrontState state(double time) const {
    const double x = at(time);
    FrontState state{.time = time, .angle = angle(x)};
    if (span > 0.0) {
      state.rate = slope(x) / span;
      state.acceleration = bend(x) / (span * span);
    }
    return state;
  }

  double start, span, c0, c1, c2, c3, c4, c5;
};

}  // namespace

FrontState Leg::at_time(double time) const {
  std::size_t i = 1;
  while (i + 1 < count && nodes[i].time < time) ++i;
  FrontState state = Between(nodes[i - 1], nodes[i]).state(time);
  if (count == kMostNodes && end().angle != nodes[0].angle) {  // The rate that the energy gives is more exact than that of the angle.
    const double energy = energy_at(nodes, (state.angle - nodes[0].angle) / (end().angle - nodes[0].angle));
    if (energy > 0.0) state.rate = state.rate < 0.0 ? -std::sqrt(energy) : std::sqrt(energy);
  }
  return state;
}

double Leg::time_of(double angle) const {
  std::size_t i = 1;
  const double sign = end().angle >= nodes[0].angle ? 1.0 : -1.0;
  while (i + 1 < count && sign * (nodes[i].angle - angle) < 0.0) ++i;
  double low = nodes[i - 1].time;
  double high = nodes[i].time;
  const double span = nodes[i].angle - nodes[i - 1].angle;
  double time = span == 0.0 ? low : low + (high - low) * (angle - nodes[i - 1].angle) / span;
  const Between way(nodes[i - 1], nodes[i]);
  for (int round = 0; round < 60 && low < high; ++round) {  // Newton, kept between what is known to be before and after.
    const double x = way.at(time);
    const double miss = way.angle(x) - angle;
    (sign * miss < 0.0 ? low : high) = time;
    double better = time - miss * way.span / way.slope(x);
    if (!(better > low && better < high)) better = 0.5 * (low + high);
    const bool settled = std::fabs(better - time) <= kSettled * (nodes[i].time - nodes[i - 1].time);
    time = better;
    if (settled) break;
  }
  return time;
}

Leg make_slow_leg(const Train& train, const FrontState& start, const LegGoal& goal) {
  // No further than a twentieth of a radian, however fast it is.
  double step = std::min(goal.slow_step, 0.05 / std::max(std::fabs(start.rate), 1e-9));
  FrontState to = runge_kutta(train, start, goal.direction, step);
  Leg leg;
  leg.count = 2;
  const bool turned = goal.direction * to.rate <= 0.0;
  if (turned) {
    for (int round = 0; round < 8 && to.acceleration != 0.0; ++round) {
      step = std::clamp(step - to.rate / to.acceleration, 0.0, goal.slow_step);
      to = runge_kutta(train, start, goal.direction, step);
    }
    to.rate = 0.0;
  }
  if (goal.direction * (to.angle - goal.angle) >= 0.0) {
    for (int round = 0; round < 8 && to.rate != 0.0; ++round) {
      step = std::clamp(step - (to.angle - goal.angle) / to.rate, 0.0, goal.slow_step);
      to = runge_kutta(train, start, goal.direction, step);
    }
    to.angle = goal.angle;
    leg.reached = true;
  }
  leg.nodes[0] = start;
  leg.nodes[0].acceleration = train.view(start.angle, goal.direction).acceleration(start.rate);
  leg.nodes[1] = to;
  return leg;
}

namespace {

// Whether what slows the front at the start would stop it on the way, if it stayed as strong: then it may stop and turn round between two
// nodes of a collocation step, which would not see it.
bool may_stop(const FrontState& start, double span, const LegGoal& goal) {
  return -2.0 * goal.start.torque * span > start.rate * start.rate * goal.start.inertia;
}

}  // namespace

Leg make_leg(Train& train, const FrontState& start, const LegGoal& goal) {
  bool turns_over = true;  // For all we know.
  double span = goal.angle - start.angle;
  if (start.rate != 0.0) {
    for (int halving = 0; halving <= kMostHalvings; ++halving, span *= 0.5) {
      if (may_stop(start, span, goal)) continue;
      Leg leg = collocate(train, start, span, goal);
      if (halving == 0) turns_over = leg.turns_over;
      leg.turns_over = turns_over;
      if (leg.count != 0) {
        leg.reached = leg.swept = halving == 0;
        if (leg.reached) leg.nodes[4].angle = goal.angle;
        return leg;
      }
    }
  }
  Leg leg = make_slow_leg(train, start, goal);
  leg.turns_over = turns_over;
  return leg;
}

}  // namespace topple::hinge
