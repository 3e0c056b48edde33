#include "layout/spline.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace topple {
namespace {

/// Slope at t1 of the parabola through (t0, p0), (t1, p1), (t2, p2), in the order of the arguments, whatever the order of the times.
Vec3 parabola_slope(const Vec3& p0, double t0, const Vec3& p1, double t1, const Vec3& p2, double t2) {
  const Vec3 to0 = (1.0 / (t0 - t1)) * (p0 - p1);
  const Vec3 to2 = (1.0 / (t2 - t1)) * (p2 - p1);
  return (1.0 / (t2 - t0)) * ((t2 - t1) * to0 + (t1 - t0) * to2);
}

}  // namespace

Spline::Spline(std::span<const Vec3> points) {
  const std::size_t n = points.size();
  // Knots: the square root of the chord makes it centripetal.
  std::vector<double> time(n, 0.0);
  for (std::size_t i = 1; i < n; ++i) time[i] = time[i - 1] + std::sqrt(norm(points[i] - points[i - 1]));
  std::vector<Vec3> slope(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (n == 2) {
      slope[i] = (1.0 / time[1]) * (points[1] - points[0]);
    } else if (i == 0) {
      slope[i] = parabola_slope(points[1], time[1], points[0], time[0], points[2], time[2]);
    } else if (i == n - 1) {
      slope[i] = parabola_slope(points[i - 1], time[i - 1], points[i], time[i], points[i - 2], time[i - 2]);
    } else {
      slope[i] = parabola_slope(points[i - 1], time[i - 1], points[i], time[i], points[i + 1], time[i + 1]);
    }
  }
  cubics_.reserve(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double span = time[i + 1] - time[i];
    const Vec3 step = points[i + 1] - points[i], b = span * slope[i], end = span * slope[i + 1];
    cubics_.push_back({points[i], b, 3.0 * step - 2.0 * b - end, b + end - 2.0 * step});
    measure(i, 0.0, 1.0, cubics_.back().length(0.0, 1.0), 0);
  }
}

double Spline::Cubic::length(double from, double to) const {
  // Gauss-Legendre with five points: exact for polynomials up to degree nine.
  constexpr std::array<double, 3> kNode{0.0, 0.53846931010568309, 0.90617984593866399};
  constexpr std::array<double, 3> kWeight{0.56888888888888889, 0.47862867049936647, 0.23692688505618909};
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = kWeight[0] * norm(slope(middle));
  for (std::size_t i = 1; i < 3; ++i) sum += kWeight[i] * (norm(slope(middle - half * kNode[i])) + norm(slope(middle + half * kNode[i])));
  return half * sum;
}

/// Halves [from, to] until both halves together are as long as the whole.
void Spline::measure(std::size_t cubic, double from, double to, double whole, int depth) {
  constexpr int kMaxDepth = 20;
  constexpr double kTolerance = 1e-11;
  const double middle = 0.5 * (from + to);
  const double first = cubics_[cubic].length(from, middle), second = cubics_[cubic].length(middle, to);
  if (depth < kMaxDepth && std::abs(first + second - whole) > kTolerance * (first + second)) {
    measure(cubic, from, middle, first, depth + 1);
    measure(cubic, middle, to, second, depth + 1);
    return;
  }
  stretches_.push_back({cubic, from, middle, length_});
  stretches_.push_back({cubic, middle, to, length_ + first});
  length_ += first + second;
}

Spline::At Spline::at(double distance) {
  if (distance < stretches_[last_].start) last_ = 0;
  while (last_ + 1 < stretches_.size() && stretches_[last_ + 1].start <= distance) ++last_;
  const Stretch& stretch = stretches_[last_];
  const Cubic& cubic = cubics_[stretch.cubic];
  const double end = last_ + 1 < stretches_.size() ? stretches_[last_ + 1].start : length_;
  const double wanted = distance - stretch.start;
  // Newton from the linear guess; the speed hardly changes inside a stretch.
  double u = stretch.from + (stretch.to - stretch.from) * (end > stretch.start ? wanted / (end - stretch.start) : 0.0);
  constexpr int kSteps = 6;
  for (int i = 0; i < kSteps; ++i) {
    const double speed = norm(cubic.slope(u));
    if (!(speed > 0.0)) break;
    const double change = (wanted - cubic.length(stretch.from, u)) / speed;
    u = std::clamp(u + change, stretch.from, stretch.to);
    if (std::abs(change) < 1e-14) break;
  }
  const Vec3 slope = cubic.slope(u);
  const double speed = norm(slope);
  const Vec3 chord = cubic.point(stretch.to) - cubic.point(stretch.from);
  return {cubic.point(u), speed > 0.0 ? (1.0 / speed) * slope : (1.0 / norm(chord)) * chord};
}

}  // namespace topple
