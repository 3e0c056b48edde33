/** Where a brick is: geometry of docs/format.md. World axes, z up. */

import { Stance, type Recording } from './types.ts';

/** Size of a brick as it is put down [m]. */
export interface Extents {
  /** Along its heading. */
  along: number;
  across: number;
  up: number;
}

export function extentsOf(recording: Recording, brick: number): Extents {
  const { height, width, thickness } = recording.kinds[recording.bricks.kind[brick]];
  switch (recording.bricks.stance[brick]) {
    case Stance.flat:
      return { along: height, across: width, up: thickness };
    case Stance.onSide:
      return { along: thickness, across: height, up: width };
    default:
      return { along: thickness, across: width, up: height };
  }
}

/** Half of its thickness, width and height, along the brick's own x, y and z [m]. */
export function halfExtents(recording: Recording, brick: number): [number, number, number] {
  const { height, width, thickness } = recording.kinds[recording.bricks.kind[brick]];
  return [thickness / 2, width / 2, height / 2];
}

/** Centre of mass [m] and orientation: the rotation that takes the brick's own axes (thickness, width, height) to the world's. */
export interface Pose {
  x: number;
  y: number;
  z: number;
  qw: number;
  qx: number;
  qy: number;
  qz: number;
}

export function newPose(): Pose {
  return { x: 0, y: 0, z: 0, qw: 1, qx: 0, qy: 0, qz: 0 };
}

/** Turns the brick's own axes into those of its stance (heading, left, up), as w x y z. As src/layout/geometry.cpp has it: a flat brick lies as one that has fallen, one on its side lies on its right. */
const kStanceTurns: Record<Stance, readonly [number, number, number, number]> = {
  [Stance.standing]: [1, 0, 0, 0],
  [Stance.flat]: [Math.SQRT1_2, 0, Math.SQRT1_2, 0],
  [Stance.onSide]: [Math.SQRT1_2, Math.SQRT1_2, 0, 0],
};

/**
 * A brick turned by `angle` [rad] about the bottom edge at its front (angle > 0) or at its back (angle < 0); 0: as put down.
 * The orientation is its stance, then a turn about its left (+y), then its heading about z.
 */
export function hingedPose(recording: Recording, brick: number, angle: number, out: Pose): void {
  const { foot, heading, stance } = recording.bricks;
  const size = extentsOf(recording, brick);
  const c = Math.cos(angle);
  const s = Math.sin(angle);
  const toe = (angle >= 0 ? 0.5 : -0.5) * size.along;
  const along = toe - toe * c + 0.5 * size.up * s;
  out.x = foot[3 * brick] + along * Math.cos(heading[brick]);
  out.y = foot[3 * brick + 1] + along * Math.sin(heading[brick]);
  out.z = foot[3 * brick + 2] + toe * s + 0.5 * size.up * c;
  const ch = Math.cos(0.5 * heading[brick]);
  const sh = Math.sin(0.5 * heading[brick]);
  const ca = Math.cos(0.5 * angle);
  const sa = Math.sin(0.5 * angle);
  const [w, x, y, z] = [ch * ca, -sh * sa, ch * sa, sh * ca];
  if (stance[brick] === Stance.standing) {
    out.qw = w;
    out.qx = x;
    out.qy = y;
    out.qz = z;
    return;
  }
  const [sw, sx, sy, sz] = kStanceTurns[stance[brick] as Stance];
  out.qw = w * sw - x * sx - y * sy - z * sz;
  out.qx = w * sx + x * sw + y * sz - z * sy;
  out.qy = w * sy - x * sz + y * sw + z * sx;
  out.qz = w * sz + x * sy - y * sx + z * sw;
}

/** The angle between the brick's up as put down and the world's up [rad], 0 to pi. */
export function tiltOf(recording: Recording, brick: number, pose: Pose): number {
  const [sw, sx, sy, sz] = kStanceTurns[recording.bricks.stance[brick] as Stance];
  // The stance's up in the brick's own axes is the third row of the stance's rotation.
  const ux = 2 * (sx * sz - sw * sy);
  const uy = 2 * (sy * sz + sw * sx);
  const uz = 1 - 2 * (sx * sx + sy * sy);
  const { qw, qx, qy, qz } = pose;
  const up = 2 * (qx * qz - qw * qy) * ux + 2 * (qy * qz + qw * qx) * uy + (1 - 2 * (qx * qx + qy * qy)) * uz;
  return Math.acos(Math.min(1, Math.max(-1, up)));
}

/** The tilt at which the centre of mass stands above the toe [rad]. */
export function tipAngle(size: Extents): number {
  return Math.atan2(size.along, size.up);
}
