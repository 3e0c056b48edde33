// How well each integrator does: free fall of one brick, its error against the step.
#include <cmath>

#include "model/pivot/fall.h"
#include "topple/run.h"

namespace topple {

namespace {

constexpr double kDegree = 0.017453292519943295;

double tilt_after(const pivot::Turning& body, double theta, double duration, int steps, Integrator integrator) {
  pivot::Fall fall = pivot::fall_at(0.0, theta, 0.0);
  for (int i = 1; i <= steps; ++i) fall = pivot::advance(body, fall, duration * i / steps, integrator);
  return fall.theta;
}

double least_squares_slope(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0.0;
  double sy = 0.0;
  double sxx = 0.0;
  double sxy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sx += std::log(x[i]);
    sy += std::log(y[i]);
    sxx += std::log(x[i]) * std::log(x[i]);
    sxy += std::log(x[i]) * std::log(y[i]);
  }
  const auto n = static_cast<double>(x.size());
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace

Convergence free_fall_convergence(const Layout& layout, InertiaRule inertia) {
  const Brick& brick = layout.bricks.front();
  const BrickKind& kind = layout.kinds[brick.kind];
  const Extents size = extents(kind, brick.stance);
  const pivot::Turning body = pivot::turning(size, kind.mass, layout.gravity, inertia);
  const double start = tip_angle(size) + kDegree;
  // As long as a linearised brick needs to grow its tilt fivefold, whatever its size: some 35 degrees at the end, far from the floor.
  const double duration = std::log(10.0) / std::sqrt(body.sine);
  const double truth = tilt_after(body, start, duration, 1 << 14, Integrator::rk4);
  Convergence convergence{.time = duration, .series = {}};
  for (const Integrator integrator : {Integrator::euler, Integrator::semi_implicit, Integrator::rk4}) {
    ConvergenceSeries series{.integrator = integrator, .time_steps = {}, .errors = {}};
    const bool first_order = integrator != Integrator::rk4;
    for (int steps = first_order ? 128 : 16; steps <= (first_order ? 4096 : 512); steps *= 2) {
      series.time_steps.push_back(duration / steps);
      series.errors.push_back(std::fabs(tilt_after(body, start, duration, steps, integrator) - truth));
    }
    series.slope = least_squares_slope(series.time_steps, series.errors);
    convergence.series.push_back(series);
  }
  return convergence;
}

}  // namespace topple
