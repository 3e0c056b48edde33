/** Which brick lies under a point of the picture: the ray against every brick's box, on the processor (a million take some 30 ms). */

import type { Ray } from 'three';
import type { Playhead } from '../recording/playhead.ts';
import { halfExtents } from '../recording/pose.ts';

/** @param ray In the view's coordinates. @returns The nearest brick, or -1. */
export function pickBrick(playhead: Playhead, ray: Ray): number {
  const { position, turn, recording } = playhead;
  let best = -1;
  let nearest = Infinity;
  const { origin: o, direction: d } = ray;
  for (let brick = 0; brick < recording.bricks.count; brick++) {
    const half = halfExtents(recording, brick);
    const [px, py, pz] = [o.x - position[3 * brick], o.y - position[3 * brick + 1], o.z - position[3 * brick + 2]];
    const radius = Math.hypot(half[0], half[1], half[2]);
    const along = px * d.x + py * d.y + pz * d.z;
    if (px * px + py * py + pz * pz - along * along > radius * radius) continue;
    const [x, y, z, w] = [-turn[4 * brick], -turn[4 * brick + 1], -turn[4 * brick + 2], turn[4 * brick + 3]];
    const hit = enter(turned(x, y, z, w, px, py, pz), turned(x, y, z, w, d.x, d.y, d.z), half);
    if (hit < nearest) {
      nearest = hit;
      best = brick;
    }
  }
  return best;
}

type Triple = [number, number, number];

function turned(x: number, y: number, z: number, w: number, vx: number, vy: number, vz: number): Triple {
  const tx = 2 * (y * vz - z * vy);
  const ty = 2 * (z * vx - x * vz);
  const tz = 2 * (x * vy - y * vx);
  return [vx + w * tx + y * tz - z * ty, vy + w * ty + z * tx - x * tz, vz + w * tz + x * ty - y * tx];
}

/** Distance at which a ray enters a box about the origin, infinity if it does not. */
function enter(from: Triple, way: Triple, half: Triple): number {
  let [near, far] = [0, Infinity];
  for (let axis = 0; axis < 3; axis++) {
    const slope = 1 / way[axis];
    const a = (-half[axis] - from[axis]) * slope;
    const b = (half[axis] - from[axis]) * slope;
    near = Math.max(near, Math.min(a, b));
    far = Math.min(far, Math.max(a, b));
  }
  return near <= far ? near : Infinity;
}
