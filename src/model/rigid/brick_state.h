/// One brick that moves (or stands in the way of one that does): what the step gathers.
#pragma once

#include <cstdint>

#include "model/rigid/matrix.h"
#include "topple/layout.h"

namespace topple::rigid {

/// State and constants of a brick; six degrees of freedom.
struct Body {
  Vec3 position;  ///< Centre of mass [m].
  Quat orientation;
  Vec3 velocity;              ///< [m/s]
  Vec3 angular_velocity;      ///< World axes [rad/s].
  Mat3 axes;                  ///< Rotation matrix of `orientation`.
  Mat3 inverse_inertia;       ///< World axes [1/(kg m^2)]; zero for a brick that does not move.
  Vec3 gyroscopic;            ///< Angular acceleration of free rotation [rad/s^2].
  Vec3 half;                  ///< Half extents along its own axes [m].
  double inverse_mass = 0.0;  ///< [1/kg]; zero for a brick that does not move.
  Vec3 inertia;               ///< About its own axes [kg m^2].
  double radius = 0.0;        ///< Of the sphere around it [m].
  BrickId id = kNoBrick;
  std::uint16_t kind = 0;
  bool round = false;  ///< A ball; each of `half` is its radius.
};

/// Sets what follows from the pose.
void refresh(Body& body);

/// Its angular acceleration while no torque acts [rad/s^2].
Vec3 free_rotation(const Body& body);

/// Moves a body by its velocities for `time` [s]; second order in time, angular momentum kept exactly.
void drift(Body& body, double time);

/// A body of this kind at rest at a pose.
Body make_body(const BrickKind& kind, BrickId id, std::uint16_t kind_index, const Pose& pose);

double kinetic_energy(const Body& body);  ///< [J]

inline Vec3 velocity_at(const Body& body, const Vec3& arm) { return body.velocity + cross(body.angular_velocity, arm); }

}  // namespace topple::rigid
