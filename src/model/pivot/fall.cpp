#include "model/pivot/fall.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace topple::pivot {

double moment_of_inertia(const Extents& size, double mass, InertiaRule rule) {
  // [Arnesson2020] (2.4) divides by 12, which is about the centre of mass; the brick turns about an edge, where it is 3 (Steiner).
  const double divisor = rule == InertiaRule::report ? 12.0 : 3.0;
  return mass * (size.up * size.up + size.along * size.along) / divisor;
}

Turning turning(const Extents& size, double mass, double gravity, InertiaRule rule) {
  const double weight_over_inertia = mass * gravity / moment_of_inertia(size, mass, rule);
  return {.sine = 0.5 * weight_over_inertia * size.up, .cosine = 0.5 * weight_over_inertia * size.along};
}

Fall rk4(const Turning& body, const Fall& from, double until) {
  // Every stage sees the force of the step's beginning.
  const double t = from.time;
  const double h = until - t;
  const double k1 = body.acceleration(from.turned, t);
  const double w2 = from.omega + 0.5 * h * k1;
  const double k2 = body.acceleration(sin_cos(from.theta + 0.5 * h * from.omega), t);
  const double w3 = from.omega + 0.5 * h * k2;
  const double k3 = body.acceleration(sin_cos(from.theta + 0.5 * h * w2), t);
  const double w4 = from.omega + h * k3;
  const double k4 = body.acceleration(sin_cos(from.theta + h * w3), t);
  return fall_at(until, from.theta + h / 6.0 * (from.omega + 2.0 * w2 + 2.0 * w3 + w4),
                 from.omega + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4));
}

double time_of_passing(const Turning& body, const Fall& from, double until, double theta, Integrator integrator) {
  double low = from.time;
  double high = until;
  double below = from.theta - theta;
  if (below >= 0.0) return from.time;
  // Most steps end far below, whatever acts on the brick.
  const double h = until - from.time;
  const double most = std::fabs(from.omega) + h * (body.sine + body.cosine + std::fabs(body.push));
  if (below + h * most < 0.0) return std::numeric_limits<double>::infinity();
  double above = advance(body, from, until, integrator).theta - theta;
  if (!(above >= 0.0)) return std::numeric_limits<double>::infinity();
  // Regula falsi, the value of an end kept twice halved (Illinois); Euler's step is linear in time, so that the first guess is exact.
  int kept = 0;
  for (int i = 0; i < 60; ++i) {
    // A root often lies between two neighbouring times: then it is the later one.
    const double after_low = std::nextafter(low, high);
    if (after_low >= high) return high;
    const double middle = std::clamp(high - above * (high - low) / (above - below), after_low, std::nextafter(high, low));
    const double value = advance(body, from, middle, integrator).theta - theta;
    if (std::fabs(value) < 1e-15) return middle;
    if (value < 0.0) {
      low = middle;
      below = value;
      if (kept == 1) above *= 0.5;
      kept = 1;
    } else {
      high = middle;
      above = value;
      if (kept == -1) below *= 0.5;
      kept = -1;
    }
  }
  return high;
}

}  // namespace topple::pivot
