/// A contact point in its own frame, as the sweeps and the augmented Lagrangian see it.
#pragma once

#include <span>

#include "model/rigid/contact_row.h"

namespace topple::rigid {

struct SweepRow {
  int a = 0;
  int b = kFloor;
  Vec3 arm_a, arm_b;           // From the centres of mass to the point [m].
  Vec3 normal, along, across;  // An orthonormal frame; the normal from b to a.
  double bias = 0.0;           // Added to the normal velocity before it is held at or above zero [m/s].
  double bias_along = 0.0, bias_across = 0.0;
  double k_nn = 0.0, k_na = 0.0, k_nc = 0.0, k_aa = 0.0, k_ac = 0.0, k_cc = 0.0;  // Velocity per impulse [1/kg].
  double give_normal = 0.0, give = 0.0;  // Compliance along and across the normal: what an impulse leaves of the velocity [1/kg].
  double friction = 0.0;
  double base = 0.0;                 // Normal impulse that acts already and counts for friction [N s].
  double n = 0.0, s = 0.0, t = 0.0;  // Impulses so far: normal, along, across [N s].
};

/// Gives both bricks of a point an impulse, in its own frame [N s].
void apply(std::span<Body> bodies, const SweepRow& row, double n, double s, double t);

}  // namespace topple::rigid
