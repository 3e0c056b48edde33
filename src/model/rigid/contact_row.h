/// A contact point as the solvers see it: in its own frame, with all that its bricks' velocities do to it and it to them.
#pragma once

#include <array>
#include <span>

#include "model/rigid/small_block.h"
#include "model/rigid/touch.h"

namespace topple::rigid {

struct LaneKernels;

/// Of the three directions of a frame: along the normal, and two ways across it.
using Framed = std::array<double, 3>;

/// Linear velocity, then spin, about world axes [m/s, rad/s].
using Velocity = Column<6>;

/// The six numbers of both bricks stand two by two beside each other, so that one register holds as much of either: where the k-th of brick
/// 0 (a) or 1 (b) is.
constexpr std::size_t beside(std::size_t brick, std::size_t k) { return 4 * (k / 2) + 2 * brick + k % 2; }

/// One contact point, ready to be solved. Its slip is the velocity of a's point against b's.
struct ContactRow {
  int a = 0;
  int b = kFloor;
  int touch = 0;
  int point = 0;
  double friction = 0.0;
  double base = 0.0;   ///< Normal impulse that acts already and counts for friction [N s].
  Framed impulse{};    ///< On a: the guess, then the truth [N s].
  ContactState state;  ///< The guess, then the truth.
  Framed bias{};       ///< Added to the slip before the laws of contact hold [m/s].
  /// Its slip along each direction, per velocity of its bricks (b's with its sign); and the velocity that an impulse along each direction
  /// gives to them [1/kg, 1/(kg m)]. In the order of beside().
  alignas(32) double of[3][12] = {};
  alignas(32) double gain[3][12] = {};
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
void set_couplings(ContactRow& row, const Body& a, const Body* b, const LaneKernels& kernels);
/// Sets what a sweep needs, once the stiffnesses are known.
void set_steps(ContactRow& row);

inline Vec3 friction_of(const ContactRow& row) { return row.impulse[1] * row.along + row.impulse[2] * row.across; }

}  // namespace topple::rigid
