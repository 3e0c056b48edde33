/// Elementary functions that give the same bits on every machine. The C libraries of a desktop and of a browser agree on sqrt alone,
/// so whatever decides where a brick is uses these. Accurate to about 1e-16 relative, for finite arguments.
#pragma once

namespace topple {

inline constexpr double kPi = 3.14159265358979323846;

struct SinCos {
  double sin = 0.0;
  double cos = 1.0;
};

/// Both at once; |x| up to 1e6 [rad].
SinCos sin_cos(double x);

double arc_tangent(double y, double x);  ///< In (-pi, pi] [rad].
double arc_sine(double x);               ///< x in [-1, 1]; in [-pi/2, pi/2] [rad].
double arc_cosine(double x);             ///< x in [-1, 1]; in [0, pi] [rad].
double natural_log(double x);            ///< x > 0 and normal.

}  // namespace topple
