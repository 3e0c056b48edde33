/** Hermite interpolation between two knots, as docs/format.md fixes it. */

/** Angle [rad], its rate [rad/s] and acceleration [rad/s²]. */
export interface Turn {
  angle: number;
  rate: number;
  acceleration: number;
}

/**
 * The angle is the quintic Hermite polynomial through angle, rate and acceleration at both ends, which fixes where a brick is.
 * Rate and acceleration are drawn between what the model had at the knots (the rate by the cubic through rates and accelerations,
 * the acceleration by a straight line) and not as derivatives of the quintic: an integrator such as explicit Euler moves the
 * angle by the rate of half a step before, and the quintic's derivatives would show that as ripples that no model had.
 * @param s Where, 0 at the first knot and 1 at the second.
 * @param h Time between the knots [s], over 0.
 */
export function turnBetweenKnots(
  s: number, h: number,
  p0: number, v0: number, a0: number,
  p1: number, v1: number, a1: number,
  out: Turn,
): void {
  // In s, with derivatives scaled by h and h²: p = c0 + c1 s + ... + c5 s^5.
  const c1 = v0 * h;
  const c2 = 0.5 * a0 * h * h;
  const dp = p1 - p0 - c1 - c2;
  const dv = v1 * h - c1 - 2 * c2;
  const da = a1 * h * h - 2 * c2;
  const c3 = 10 * dp - 4 * dv + 0.5 * da;
  const c4 = -15 * dp + 7 * dv - da;
  const c5 = 6 * dp - 3 * dv + 0.5 * da;
  out.angle = p0 + s * (c1 + s * (c2 + s * (c3 + s * (c4 + s * c5))));
  out.rate = cubic(s, h, v0, a0, v1, a1);
  out.acceleration = a0 + s * (a1 - a0);
}

/** Cubic Hermite polynomial through value and rate at both ends; `s` and `h` as above. */
export function cubic(s: number, h: number, p0: number, v0: number, p1: number, v1: number): number {
  const c1 = v0 * h;
  const c2 = 3 * (p1 - p0) - 2 * c1 - v1 * h;
  const c3 = 2 * (p0 - p1) + c1 + v1 * h;
  return p0 + s * (c1 + s * (c2 + s * c3));
}
