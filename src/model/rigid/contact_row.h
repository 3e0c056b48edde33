/// A contact point as the solvers see it.
#pragma once

#include <span>

#include "model/rigid/touch.h"

namespace topple::rigid {

/// One contact point, ready to be solved. Its slip is the velocity of a's point against b's.
struct ContactRow {
  int a = 0;
  int b = kFloor;
  int touch = 0;
  int point = 0;
  Vec3 arm_a, arm_b;  ///< From the centres of mass to the point [m].
  Vec3 normal;        ///< From b to a, unit.
  Vec3 bias;          ///< Added to the slip before the laws of contact hold [m/s].
  double friction = 0.0;
  double base = 0.0;               ///< Normal impulse that has been applied already and counts for friction [N s].
  double normal_stiffness = 0.0;   ///< Impulse per velocity that is left: 1 / compliance [kg].
  double tangent_stiffness = 0.0;  ///< [kg]
  double normal_mass = 0.0;        ///< Impulse per velocity of the point along its normal, if nothing else touched [kg].
  double mass = 0.0;               ///< The same across it [kg].
  ContactState state;              ///< The guess, then the truth.
  double n = 0.0;                  ///< Normal impulse: the guess, then the truth [N s].
  Vec3 friction_impulse;           ///< On a: the same [N s].
};

/// Gives both bricks of a point an impulse [N s]; `impulse` is that on a.
void apply(std::span<Body> bodies, const ContactRow& row, const Vec3& impulse);

}  // namespace topple::rigid
