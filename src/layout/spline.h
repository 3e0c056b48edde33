/// A smooth plane curve through points, walked by arc length.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "topple/base.h"

namespace topple {

/// Centripetal Catmull-Rom [Yuksel2011]: passes through its points, without loops or cusps between them. Its ends are those of the
/// parabola through the three outermost points; through two points it is straight.
class Spline {
 public:
  /// At least two points, no two neighbours in one place.
  explicit Spline(std::span<const Vec3> points);

  double length() const { return length_; }  ///< [m], to about 1e-9 of itself.

  struct At {
    Vec3 point;
    Vec3 tangent;  ///< Unit length.
  };
  /// Where one is after walking `distance` [m] from the first point, 0 to length(). Fast where distances come in ascending order.
  At at(double distance);

 private:
  /// One cubic: point(u) = a + b u + c u^2 + d u^3, u from 0 to 1.
  struct Cubic {
    Vec3 a, b, c, d;
    Vec3 point(double u) const { return a + u * (b + u * (c + u * d)); }
    Vec3 slope(double u) const { return b + u * (2.0 * c + (3.0 * u) * d); }
    double length(double from, double to) const;
  };
  /// A stretch of one cubic short enough for a single quadrature.
  struct Stretch {
    std::size_t cubic = 0;
    double from = 0.0, to = 0.0;  // u
    double start = 0.0;           // arc length at `from`
  };
  void measure(std::size_t cubic, double from, double to, double whole, int depth);

  std::vector<Cubic> cubics_;
  std::vector<Stretch> stretches_;
  double length_ = 0.0;
  std::size_t last_ = 0;  // the stretch of the last walk
};

}  // namespace topple
