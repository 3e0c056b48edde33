/** Where to look from. All in metres, z up, relative to the view's origin. */

import { MathUtils, PerspectiveCamera, Vector3 } from 'three';

/** A camera's place and what it looks at. */
export interface Aim {
  position: Vector3;
  target: Vector3;
}

/** Parts of the view that are covered, as fractions of its width and height: what is framed keeps clear of them. */
export interface Insets {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

/** Direction of the longest spread of points in the plane, and how round they lie: 0 a line, 1 a circle. */
export function mainAxis(points: readonly Vector3[]): { x: number; y: number; roundness: number } {
  let [mx, my] = [0, 0];
  for (const p of points) {
    mx += p.x / points.length;
    my += p.y / points.length;
  }
  let [xx, xy, yy] = [0, 0, 0];
  for (const p of points) {
    xx += (p.x - mx) ** 2;
    xy += (p.x - mx) * (p.y - my);
    yy += (p.y - my) ** 2;
  }
  const angle = 0.5 * Math.atan2(2 * xy, xx - yy);
  const half = Math.hypot(0.5 * (xx - yy), xy);
  const [major, minor] = [0.5 * (xx + yy) + half, 0.5 * (xx + yy) - half];
  return { x: Math.cos(angle), y: Math.sin(angle), roundness: major > 0 ? Math.sqrt(Math.max(0, minor / major)) : 1 };
}

/**
 * The way the first view looks: along the run, so that near bricks are big, and the wave comes from afar; steeper and more
 * from the side the rounder the run lies.
 */
export function defaultDirection(points: readonly Vector3[]): Vector3 {
  const axis = mainAxis(points);
  const first = points[0];
  const last = points[points.length - 1];
  const along = (last.x - first.x) * axis.x + (last.y - first.y) * axis.y < 0 ? -1 : 1;
  const azimuth = Math.atan2(-along * axis.y, -along * axis.x) + MathUtils.lerp(0.6, 1.0, axis.roundness);
  const elevation = MathUtils.lerp(0.3, 0.62, Math.min(1, axis.roundness * 1.5));
  return new Vector3(Math.cos(azimuth) * Math.cos(elevation), Math.sin(azimuth) * Math.cos(elevation), -Math.sin(elevation));
}

/**
 * The nearest place from which a camera looking along `forward` has all points in view.
 * @param camera Gives the field of view and the shape of the picture.
 */
export function frame(points: readonly Vector3[], forward: Vector3, camera: PerspectiveCamera, insets: Insets): Aim {
  const ahead = forward.clone().normalize();
  const worldUp = Math.abs(ahead.z) > 0.999 ? new Vector3(0, 1, 0) : new Vector3(0, 0, 1);
  const right = new Vector3().crossVectors(ahead, worldUp).normalize();
  const up = new Vector3().crossVectors(right, ahead);
  const tallness = Math.tan(MathUtils.degToRad(camera.fov) / 2);
  const wideness = tallness * camera.aspect;
  // Slopes of the four sides of the free part of the picture.
  const [left, rightSide] = [wideness * (1 - 2 * insets.left), wideness * (1 - 2 * insets.right)];
  const [top, bottom] = [tallness * (1 - 2 * insets.top), tallness * (1 - 2 * insets.bottom)];
  // A point (a, b, depth c) is inside if -left (c + d) <= a - x and so on, for a camera at x right, y up, d back.
  let [maxA, minA, maxB, minB] = [-Infinity, Infinity, -Infinity, Infinity];
  let nearest = Infinity;
  for (const p of points) {
    const [a, b, c] = [p.dot(right), p.dot(up), p.dot(ahead)];
    maxA = Math.max(maxA, a - rightSide * c);
    minA = Math.min(minA, a + left * c);
    maxB = Math.max(maxB, b - top * c);
    minB = Math.min(minB, b + bottom * c);
    nearest = Math.min(nearest, c);
  }
  const d = Math.max((maxA - minA) / (left + rightSide), (maxB - minB) / (top + bottom), 0.05 - nearest);
  const x = 0.5 * (maxA - rightSide * d + minA + left * d);
  const y = 0.5 * (maxB - top * d + minB + bottom * d);
  const position = new Vector3().addScaledVector(right, x).addScaledVector(up, y).addScaledVector(ahead, -d);
  const middle = points.reduce((sum, p) => sum.addScaledVector(p, 1 / points.length), new Vector3());
  const depth = Math.max(0.05, middle.clone().sub(position).dot(ahead));
  return { position, target: position.clone().addScaledVector(ahead, depth) };
}
