/// One brick leaning on the next: kinematics and lever arms, in units of the height of the brick behind.
///
/// Both turn about their toes; f is the angle of the brick ahead, b of the brick behind, D = b - f; p the pitch (toe to toe), t the
/// thickness of the brick ahead, both over the height of the brick behind; mu the friction.
/// [vanLeeuwen2010] eq. 15, 24, 25 and 30, for bricks of one size; derived again for bricks of any size in docs/hinge.md.
#pragma once

#include "model/hinge/lanes.h"

namespace topple::hinge {

/// Of one number or of two side by side.
template <typename Number>
struct Lean {
  Number sin_behind;
  Number cos_behind;
  Number sin_lean;   ///< sin D.
  Number ratio;      ///< db/df.
  Number curvature;  ///< d2b/df2 [1/rad].
  Number gain;       ///< Torque on the brick ahead over the torque that it takes from the brick behind.
};

/// The top front edge of the brick behind slides down the rear face of the brick ahead: sin D = p cos f - t.
/// Per unit of normal force the brick ahead gets the torque (cos D - p sin f) - mu t, the brick behind loses cos D + mu sin D.
template <typename Number>
Lean<Number> lean_on_face(double p, double t, double mu, Number sin_f, Number cos_f) {
  const Number sin_d = p * cos_f - t;
  const Number cos_d = square_root(1.0 - sin_d * sin_d);
  const Number inverse = 1.0 / cos_d;
  const Number drop = p * sin_f * inverse;  // -dD/df
  return {.sin_behind = sin_f * cos_d + cos_f * sin_d,
          .cos_behind = cos_f * cos_d - sin_f * sin_d,
          .sin_lean = sin_d,
          .ratio = 1.0 - drop,
          .curvature = (drop * drop * sin_d - p * cos_f) * inverse,
          .gain = (cos_d - p * sin_f - mu * t) / (cos_d + mu * sin_d)};
}

/// The brick ahead has turned further than the one behind: the front face of the brick behind rests on the rear bottom edge (the heel)
/// of the brick ahead, p cos b = t cos D. Their distance along that face is l, l^2 = p^2 - 2 p t cos f + t^2.
/// Per unit of normal force the brick ahead gets -t sin D, the brick behind loses l. Friction is left out: the published theory ends
/// here, and as the chain keeps its contacts even where they would have to pull, friction could create energy.
template <typename Number>
Lean<Number> lean_on_heel(double p, double t, Number sin_f, Number cos_f) {
  const Number along = p - t * cos_f;
  const Number up = t * sin_f;
  const Number inverse = 1.0 / square_root(along * along + up * up);
  const Number sin_b = along * inverse;
  const Number cos_b = up * inverse;
  const Number sin_d = sin_b * cos_f - cos_b * sin_f;
  const Number cos_d = cos_b * cos_f + sin_b * sin_f;
  const Number ratio = -t * sin_d * inverse;
  return {.sin_behind = sin_b,
          .cos_behind = cos_b,
          .sin_lean = sin_d,
          .ratio = ratio,
          .curvature = t * cos_d * inverse * (1.0 - 2.0 * ratio),
          .gain = ratio};
}

}  // namespace topple::hinge
