/// One brick turning about its lower edge: the report's equation of motion and three ways to integrate it.
#pragma once

#include "base/trigonometry.h"
#include "topple/layout.h"
#include "topple/model.h"

namespace topple::pivot {

/// What turns a brick, divided by its moment of inertia; theta = tilt [rad].
/// theta'' = push + sine sin(theta) - cosine cos(theta), which is (2.3) of [Arnesson2020] with d(theta) = T/2 cos(theta) - H/2 sin(theta).
struct Turning {
  double sine = 0.0;        ///< m g H / (2 I) [1/s^2]
  double cosine = 0.0;      ///< m g T / (2 I) [1/s^2]
  double push = 0.0;        ///< F r / I while the force acts [1/s^2]
  double push_until = 0.0;  ///< [s]

  /// At a tilt whose sine and cosine are `turned`, at a time [rad/s^2].
  double acceleration(const SinCos& turned, double time) const {
    const double gravity = sine * turned.sin - cosine * turned.cos;
    return time < push_until ? push + gravity : gravity;
  }
};

/// Tilt and its derivative at a time; the sine and cosine of the tilt are kept with it, since everything asks for them.
struct Fall {
  double time = 0.0;   ///< [s]
  double theta = 0.0;  ///< [rad]
  double omega = 0.0;  ///< [rad/s]
  SinCos turned;       ///< Of theta.
};
inline Fall fall_at(double time, double theta, double omega) { return {time, theta, omega, sin_cos(theta)}; }

/// Moment of inertia about the edge it turns on, or as the report prints it, about the centre of mass [kg m^2].
double moment_of_inertia(const Extents& size, double mass, InertiaRule rule);

Turning turning(const Extents& size, double mass, double gravity, InertiaRule rule);

/// One step of the integrator to `until`, split where a force ends.
Fall advance(const Turning& body, Fall from, double until, Integrator integrator);

/// When the same step passes `theta` on its way up [s]; later than `until` if it does not.
double time_of_passing(const Turning& body, const Fall& from, double until, double theta, Integrator integrator);

}  // namespace topple::pivot
