/// The polynomials between two knots.
#pragma once

#include <cmath>

#include "topple/model.h"
#include "topple/recording.h"

namespace topple {

/// The quintic in u = 0..1 that has the angle, rate and acceleration of both its ends; without its constant term, the first angle.
struct Quintic {
  double c1 = 0.0, c2 = 0.0, c3 = 0.0, c4 = 0.0, c5 = 0.0;

  double at(double u) const { return u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5)))); }
  double slope(double u) const { return c1 + u * (2.0 * c2 + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5))); }
  double most_bend() const { return 2.0 * std::abs(c2) + 6.0 * std::abs(c3) + 12.0 * std::abs(c4) + 20.0 * std::abs(c5); }  ///< Or less.
  double bend(double u) const { return 2.0 * c2 + u * (6.0 * c3 + u * (12.0 * c4 + u * 20.0 * c5)); }
};

/// `span`: time between the knots [s], more than 0.
inline Quintic quintic(const HingedKnot& first, const HingedKnot& last, double span) {
  const double v0 = double{first.rate} * span;
  const double q0 = 0.5 * double{first.acceleration} * span * span;
  // What is left for the three higher powers to do: of the angle, its slope and its bend at u = 1.
  const double angle = double{last.angle} - double{first.angle} - v0 - q0;
  const double slope = double{last.rate} * span - v0 - 2.0 * q0;
  const double bend = double{last.acceleration} * span * span - 2.0 * q0;
  return {v0, q0, 10.0 * angle - 4.0 * slope + 0.5 * bend, -15.0 * angle + 7.0 * slope - bend, 6.0 * angle - 3.0 * slope + 0.5 * bend};
}

/// The state `time` seconds after the start of a hinged track; before its first knot the first, after its last knot the last.
HingedState state_at(std::span<const HingedKnot> knots, double time);

/// A free brick at a moment, its position against the brick as put down.
struct FreeState {
  Vec3 offset;  ///< [m]
  Quat orientation;
  Vec3 velocity;          ///< [m/s]
  Vec3 angular_velocity;  ///< In world axes [rad/s].
};
FreeState state_at(std::span<const FreeKnot> knots, double time);

/// The same between two knots, `span` seconds apart, at u = 0..1.
FreeState between(const FreeKnot& first, const FreeKnot& last, double span, double u);

}  // namespace topple
