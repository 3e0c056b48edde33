/// A contact point as the solvers see it: in its own frame, with all that its bricks' velocities do to it and it to them.
#pragma once

#include <array>
#include <span>

#include "model/rigid/small_block.h"
#include "model/rigid/touch.h"

namespace topple::rigid {

/// Of the three directions of a frame: along the normal, and two ways across it.
using Framed = std::array<double, 3>;

/// Linear velocity, then spin, about world axes [m/s, rad/s].
using Velocity = Column<6>;

/// One contact point, ready to be solved. Its slip is the velocity of a's point against b's.
struct ContactRow {
  int a = 0;
  int b = kFloor;
  int touch = 0;
  int point = 0;
  double friction = 0.0;
  double base = 0.0;                           ///< Normal impulse that acts already and counts for friction [N s].
  Framed impulse{};                            ///< On a: the guess, then the truth [N s].
  ContactState state;                          ///< The guess, then the truth.
  Framed bias{};                               ///< Added to the slip before the laws of contact hold [m/s].
  std::array<Velocity, 3> of_a{}, of_b{};      ///< Its slip along each direction, per velocity of either brick (b's with its sign).
  std::array<Velocity, 3> gain_a{}, gain_b{};  ///< Velocity that an impulse along each direction gives to either brick [1/kg, 1/(kg m)].
  double k_nn = 0.0, k_na = 0.0, k_nc = 0.0, k_aa = 0.0, k_ac = 0.0, k_cc = 0.0;  ///< Its own slip per impulse [1/kg].
  double normal_mass = 0.0;        ///< Impulse per velocity of the point along its normal, if nothing else touched [kg].
  double mass = 0.0;               ///< The same across it, either way alike [kg].
  double normal_stiffness = 0.0;   ///< Impulse per velocity that is left: 1 / compliance [kg].
  double tangent_stiffness = 0.0;  ///< [kg]
  // What a sweep needs of that.
  double give_normal = 0.0, give = 0.0;                ///< Compliances [1/kg].
  double step_normal = 0.0, step_sliding = 0.0;        ///< Impulse per velocity, compliance included [kg].
  double step_aa = 0.0, step_ac = 0.0, step_cc = 0.0;  ///< The same across, as a matrix [kg].
  Vec3 normal, along, across;                          ///< An orthonormal frame; the normal from b to a.
  Vec3 arm_a, arm_b;                                   ///< From the centres of mass to the point [m].
};

/// Sets the frame and all that follows from it, the normal and the arms; `b` is null for the floor.
void set_frame(ContactRow& row, const Body& a, const Body* b);
/// Sets what a sweep needs, once the stiffnesses are known.
void set_steps(ContactRow& row);

inline Vec3 friction_of(const ContactRow& row) { return row.impulse[1] * row.along + row.impulse[2] * row.across; }

inline double product_of(const Velocity& of, const Velocity& v) {
  // Two sums, so that both fit the lanes of one register.
  return ((of[0] * v[0] + of[2] * v[2]) + of[4] * v[4]) + ((of[1] * v[1] + of[3] * v[3]) + of[5] * v[5]);
}

/// Adds the impulses of a point, `change` along each of its directions, to the velocities of both bricks.
inline void apply(const ContactRow& row, const Framed& change, std::span<Velocity> velocity) {
  Velocity& a = velocity[static_cast<std::size_t>(row.a)];
  for (std::size_t i = 0; i < 6; ++i) a[i] += change[0] * row.gain_a[0][i] + change[1] * row.gain_a[1][i] + change[2] * row.gain_a[2][i];
  if (row.b == kFloor) return;
  Velocity& b = velocity[static_cast<std::size_t>(row.b)];
  for (std::size_t i = 0; i < 6; ++i) b[i] += change[0] * row.gain_b[0][i] + change[1] * row.gain_b[1][i] + change[2] * row.gain_b[2][i];
}

}  // namespace topple::rigid
