/** A brick's outline in the picture: the hull of its eight projected corners. Drawn over the view, so that it is crisp at any zoom. */

import { Vector3, type PerspectiveCamera } from 'three';
import type { Playhead } from '../recording/playhead.ts';
import { halfExtents } from '../recording/pose.ts';

export interface Outline {
  /** Corners in order, x and y in CSS pixels from the upper left. */
  points: [number, number][];
  /** Its highest point in the picture. */
  top: [number, number];
}

export function outlineOf(playhead: Playhead, brick: number, camera: PerspectiveCamera, width: number, height: number): Outline | null {
  const half = halfExtents(playhead.recording, brick);
  const { position, turn } = playhead;
  const [x, y, z, w] = turn.subarray(4 * brick, 4 * brick + 4);
  const corners: [number, number][] = [];
  for (let i = 0; i < 8; i++) {
    const corner = new Vector3(i & 1 ? half[0] : -half[0], i & 2 ? half[1] : -half[1], i & 4 ? half[2] : -half[2]);
    corner.applyQuaternion({ x, y, z, w } as never);
    corner.add(new Vector3(position[3 * brick], position[3 * brick + 1], position[3 * brick + 2])).project(camera);
    if (corner.z > 1 || corner.z < -1) return null;
    corners.push([(0.5 + 0.5 * corner.x) * width, (0.5 - 0.5 * corner.y) * height]);
  }
  const points = hull(corners);
  const top = points.reduce((best, p) => (p[1] < best[1] ? p : best));
  const middle = points.reduce((sum, p) => sum + p[0] / points.length, 0);
  return { points, top: [middle, top[1]] };
}

/** Convex hull, counter-clockwise in the picture (Andrew's chain). */
export function hull(points: [number, number][]): [number, number][] {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const chain = (list: [number, number][]): [number, number][] => {
    const out: [number, number][] = [];
    for (const p of list) {
      while (out.length >= 2 && cross(out[out.length - 2], out[out.length - 1], p) <= 0) out.pop();
      out.push(p);
    }
    out.pop();
    return out;
  };
  return [...chain(sorted), ...chain(sorted.reverse())];
}

function cross(o: [number, number], a: [number, number], b: [number, number]): number {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}
