/// How far one brick may turn before the brick ahead of it stops it: closed forms for neighbours in line, the root of the true
/// distance of the two boxes for all others.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>

#include "base/trigonometry.h"
#include "model/pivot/fall.h"
#include "topple/layout.h"

namespace topple::pivot {

/// The tilt that the brick ahead allows, and how that bound moves with it.
struct Bound {
  double theta = 0.0;         ///< [rad]
  double slope = 0.0;         ///< Of the bound against the tilt ahead.
  SinCos turned;              ///< Of theta.
  bool on_rear_edge = false;  ///< Its face lies on the lower rear edge ahead, instead of its edge on the rear face.
};

/// The angle from 0 to pi/2 with this sine and cosine [rad]. A brick that leans asks for it every time it is looked at, and mostly leans
/// little on the next: then the nearest sixteenth is taken off, and of what is left, below 0.034, the series of arcsin ends soon; the
/// first term left out is below 2e-18.
inline double angle_of(const SinCos& turned) {
  if (!(turned.sin < 0.5)) return arc_tangent(turned.sin, turned.cos);
  const auto sixteenth = static_cast<std::int32_t>(16.0 * turned.sin + 16.0 / 6.0 * turned.sin * turned.sin * turned.sin + 0.5);
  const SinCos& whole = kSixteenths[static_cast<std::size_t>(sixteenth)];
  const double x = turned.sin * whole.cos - turned.cos * whole.sin;
  const double q = x * x;
  return sixteenth / 16.0 + (x + x * q * (1.0 / 6.0 + q * (3.0 / 40.0 + q * (15.0 / 336.0 + q * (105.0 / 3456.0)))));
}

/// A brick (behind) and one that it can reach (ahead). `side` is +1 for a brick that turns about its toe, -1 about its heel.
class Pair {
 public:
  Pair(const Layout& layout, BrickId behind, int behind_side, BrickId ahead, int ahead_side);

  BrickId ahead() const { return ahead_; }
  bool in_line() const { return in_line_; }

  /// Tilt of the brick behind when it touches the one ahead that still stands [rad]; not a number if it never does.
  double contact_angle() const { return contact_angle_; }

  /// Height at which it then touches [m].
  double contact_height() const { return contact_height_; }

  /// Bound on the tilt of the brick behind, which comes from `from` and would like to get to `to` [rad], when the one ahead is as
  /// `ahead` says. At least `from`; more than `to` if nothing is in the way.
  Bound bound(double from, double to, const Fall& ahead) const {
    if (!in_line_) return bound_out_of_line(from, to, ahead);
    const Bound bound = bound_in_line(ahead);
    return bound.theta >= from ? bound : Bound{.theta = from, .turned = sin_cos(from)};
  }

  /// Whether the brick behind, at a tilt with sine and cosine `behind`, certainly stays clear of the one ahead: a cheap first question.
  bool clear(const SinCos& behind, const Fall& ahead) const {
    if (!in_line_) return false;
    const SinCos& a = ahead.turned;
    const double room = pitch_ * a.cos - thickness_;
    return room >= 0.0 && height_ * (behind.sin * a.cos - behind.cos * a.sin) < room;
  }

  /// Where the one ahead stops when it falls back from `from` to `to` (<= from) onto the one behind at tilt `behind` [rad], if it does.
  std::optional<double> fall_back_stop(double behind, double from, double to) const;

 private:
  double distance(double behind, double ahead) const;
  Bound bound_in_line(const Fall& ahead) const {
    const SinCos& a = ahead.turned;
    const double rise = (pitch_ * a.cos - thickness_) / height_;
    if (!(rise >= 0.0)) return bound_on_rear_edge(ahead);
    // The upper edge on the rear face ahead: H sin(theta - ahead) = p cos(ahead) - T.
    const double level = std::sqrt(1.0 - rise * rise);
    // Sine and cosine of the sum without the sum: a long row of leaning bricks is a chain of these, one after the other, and waits for
    // no arc tangent.
    return {.theta = ahead.theta + angle_of({rise, level}),
            .slope = 1.0 - pitch_ * a.sin / (height_ * level),
            .turned = {a.sin * level + a.cos * rise, a.cos * level - a.sin * rise}};
  }
  Bound bound_on_rear_edge(const Fall& ahead) const;
  Bound bound_out_of_line(double from, double to, const Fall& ahead) const;
  double bound_slope(double behind, double ahead) const;
  void find_contact(double height);

  const Layout* layout_;
  BrickId behind_;
  BrickId ahead_;
  int behind_side_;
  int ahead_side_;
  bool aligned_ = false;    ///< Same size, same direction: the contact angle has a closed form.
  bool in_line_ = false;    ///< Near enough besides that the bounds have one too.
  double pitch_ = 0.0;      ///< Toe to toe along the heading [m].
  double height_ = 0.0;     ///< [m]
  double thickness_ = 0.0;  ///< [m]
  double contact_angle_ = 0.0;
  double contact_height_ = 0.0;
};

}  // namespace topple::pivot
