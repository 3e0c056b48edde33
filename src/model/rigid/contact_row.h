/// A contact point as the solvers see it.
#pragma once

#include <span>

#include "model/rigid/touch.h"

namespace topple::rigid {

/// One contact point, ready to be solved: velocities of the point in its own frame and what an impulse does to them.
struct ContactRow {
  int a = 0;
  int b = kFloor;
  int touch = 0;
  int point = 0;
  Vec3 arm_a, arm_b;           // From the centres of mass to the point [m].
  Vec3 normal, along, across;  // An orthonormal frame; the normal from b to a.
  double bias = 0.0;           // Added to the normal velocity before it is held at or above zero [m/s].
  double bias_along = 0.0, bias_across = 0.0;
  double k_nn = 0.0, k_na = 0.0, k_nc = 0.0, k_aa = 0.0, k_ac = 0.0, k_cc = 0.0;  // Velocity per impulse [1/kg].
  double friction = 0.0;
  double floor_impulse = 0.0;           // The normal impulse is at least this [N s].
  double n = 0.0, s = 0.0, t = 0.0;     // Impulses so far: normal, along, across [N s].
  double n0 = 0.0, s0 = 0.0, t0 = 0.0;  // Of the first half step: counted for the limits, not applied again [N s].
};

/// Gives both bricks of a point an impulse, in its own frame [N s].
void apply(std::span<Body> bodies, const ContactRow& row, double n, double s, double t);

}  // namespace topple::rigid
