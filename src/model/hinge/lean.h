/// One brick leaning on the next: kinematics and lever arms, in units of the height of the brick behind.
///
/// Both turn about their toes; f is the angle of the brick ahead, b of the brick behind, D = b - f; p the pitch (toe to toe), t the
/// thickness of the brick ahead, both over the height of the brick behind; mu the friction.
/// [vanLeeuwen2010] eq. 15, 24, 25 and 30, for bricks of one size; derived again for bricks of any size in docs/hinge.md.
#pragma once

#include <cmath>

namespace topple::hinge {

struct Lean {
  double sin_behind = 0.0;
  double cos_behind = 1.0;
  double ratio = 0.0;      ///< db/df.
  double curvature = 0.0;  ///< d2b/df2 [1/rad].
  double gain = 0.0;       ///< Torque on the brick ahead over the torque that it takes from the brick behind.
};

/// The top front edge of the brick behind slides down the rear face of the brick ahead: sin D = p cos f - t.
/// Per unit of normal force the brick ahead gets the torque (cos D - p sin f) - mu t, the brick behind loses cos D + mu sin D.
inline Lean lean_on_face(double p, double t, double mu, double sin_f, double cos_f) {
  const double sin_d = p * cos_f - t;
  const double cos_d = std::sqrt(1.0 - sin_d * sin_d);
  const double inverse = 1.0 / cos_d;
  const double drop = p * sin_f * inverse;  // -dD/df
  Lean lean;
  lean.sin_behind = sin_f * cos_d + cos_f * sin_d;
  lean.cos_behind = cos_f * cos_d - sin_f * sin_d;
  lean.ratio = 1.0 - drop;
  lean.curvature = (drop * drop * sin_d - p * cos_f) * inverse;
  lean.gain = (cos_d - p * sin_f - mu * t) / (cos_d + mu * sin_d);
  return lean;
}

/// The brick ahead has turned further than the one behind: the front face of the brick behind rests on the rear bottom edge (the heel)
/// of the brick ahead, p cos b = t cos D. Their distance along that face is l, l^2 = p^2 - 2 p t cos f + t^2.
/// Per unit of normal force the brick ahead gets -t sin D, the brick behind loses l. Friction is left out: the published theory ends
/// here, and as the chain keeps its contacts even where they would have to pull, friction could create energy.
inline Lean lean_on_heel(double p, double t, double sin_f, double cos_f) {
  const double along = p - t * cos_f;
  const double up = t * sin_f;
  const double inverse = 1.0 / std::sqrt(along * along + up * up);
  Lean lean;
  lean.sin_behind = along * inverse;
  lean.cos_behind = up * inverse;
  const double sin_d = lean.sin_behind * cos_f - lean.cos_behind * sin_f;
  const double cos_d = lean.cos_behind * cos_f + lean.sin_behind * sin_f;
  lean.ratio = -t * sin_d * inverse;
  lean.curvature = t * cos_d * inverse * (1.0 - 2.0 * lean.ratio);
  lean.gain = lean.ratio;
  return lean;
}

}  // namespace topple::hinge
