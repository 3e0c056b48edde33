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
inline Fall fall_at(double time, double theta, double omega) { return {time, theta, omega, sin_cos_of_fall(theta)}; }

/// Moment of inertia about the edge it turns on, or as the report prints it, about the centre of mass [kg m^2].
double moment_of_inertia(const Extents& size, double mass, InertiaRule rule);

Turning turning(const Extents& size, double mass, double gravity, InertiaRule rule);

/// One step of rk4; no force begins or ends inside it.
Fall rk4(const Turning& body, const Fall& from, double until);

/// One step of the integrator to `until`, inside which no force begins or ends.
inline Fall advance_smoothly(const Turning& body, const Fall& from, double until, Integrator integrator) {
  if (integrator == Integrator::rk4) return rk4(body, from, until);
  const double h = until - from.time;
  const double omega = from.omega + h * body.acceleration(from.turned, from.time);
  // [Arnesson2020] (3.1) and (3.2): both right sides at the old time; semi-implicit Euler takes the new rate for the angle.
  return fall_at(until, from.theta + h * (integrator == Integrator::euler ? from.omega : omega), omega);
}

/// One step of the integrator to `until`, split where a force ends.
inline Fall advance(const Turning& body, const Fall& from, double until, Integrator integrator) {
  if (from.time < body.push_until && body.push_until < until) {
    return advance_smoothly(body, advance_smoothly(body, from, body.push_until, integrator), until, integrator);
  }
  return advance_smoothly(body, from, until, integrator);
}

/// When the same step passes `theta` on its way up [s]; later than `until` if it does not.
double time_of_passing(const Turning& body, const Fall& from, double until, double theta, Integrator integrator);

}  // namespace topple::pivot
