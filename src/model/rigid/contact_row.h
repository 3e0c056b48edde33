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
  double base = 0.0;                       ///< Normal impulse that acts already and counts for friction [N s].
  Framed impulse{};                        ///< On a: the guess, then the truth [N s].
  ContactState state;                      ///< The guess, then the truth.
  Framed bias{};                           ///< Added to the slip before the laws of contact hold [m/s].
  std::array<Wide, 3> of_a{}, of_b{};      ///< Its slip along each direction, per velocity of either brick (b's with its sign).
  std::array<Wide, 3> gain_a{}, gain_b{};  ///< Velocity that an impulse along each direction gives to either brick [1/kg, 1/(kg m)].
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

/// Sets the directions across the normal, alike for all points of a pair.
void set_directions(ContactRow& row, const Body& a);
/// Sets all that follows from the directions and the arms; `b` is null for the floor.
void set_couplings(ContactRow& row, const Body& a, const Body* b);
/// Sets what a sweep needs, once the stiffnesses are known.
void set_steps(ContactRow& row);

inline Vec3 friction_of(const ContactRow& row) { return row.impulse[1] * row.along + row.impulse[2] * row.across; }

/// Its velocity along its own directions, bias included; bricks that do not move are left out [m/s].
inline Framed slip_of(const ContactRow& row, const Velocity* a, const Velocity* b) {
  const Wide va = a != nullptr ? wide(*a) : Wide{}, vb = b != nullptr ? wide(*b) : Wide{};
  Framed slip = row.bias;
  for (std::size_t k = 0; k < 3; ++k) {
    Two sum = row.of_a[k][0] * va[0] + row.of_a[k][1] * va[1] + row.of_a[k][2] * va[2];
    if (b != nullptr) sum += row.of_b[k][0] * vb[0] + row.of_b[k][1] * vb[1] + row.of_b[k][2] * vb[2];
    slip[k] += sum[0] + sum[1];
  }
  return slip;
}
inline Framed slip_of(const ContactRow& row, std::span<const Velocity> velocity) {
  return slip_of(row, &velocity[static_cast<std::size_t>(row.a)], row.b == kFloor ? nullptr : &velocity[static_cast<std::size_t>(row.b)]);
}

inline void push(Velocity& velocity, const std::array<Wide, 3>& gain, const Framed& impulse) {
  const Two n = both(impulse[0]), s = both(impulse[1]), t = both(impulse[2]);
  Wide v = wide(velocity);
  for (std::size_t k = 0; k < 3; ++k) v[k] += n * gain[0][k] + s * gain[1][k] + t * gain[2][k];
  velocity = narrow(v);
}

/// Adds the impulses of a point, `change` along each of its directions, to the velocities of both bricks.
inline void apply(const ContactRow& row, const Framed& change, std::span<Velocity> velocity) {
  push(velocity[static_cast<std::size_t>(row.a)], row.gain_a, change);
  if (row.b != kFloor) push(velocity[static_cast<std::size_t>(row.b)], row.gain_b, change);
}

}  // namespace topple::rigid
