/** Bricks as they lie now, seen from above: boxes by their turned corners. Light enough to draw three at once. */

import { halfExtents, type Pose } from '../recording/pose.ts';
import type { Recording } from '../recording/types.ts';

const kCorners = [-1, 1].flatMap((x) => [-1, 1].flatMap((y) => [-1, 1].map((z) => [x, y, z])));

export function drawSide(canvas: HTMLCanvasElement, recording: Recording, poseOf: (brick: number) => Pose): void {
  const { bricks, colors } = recording;
  const ratio = Math.min(2, devicePixelRatio || 1);
  canvas.width = Math.round(canvas.clientWidth * ratio);
  canvas.height = Math.round(canvas.clientHeight * ratio);
  const pen = canvas.getContext('2d');
  if (!pen || bricks.count === 0) return;
  let [lowX, highX, lowY, highY] = [Infinity, -Infinity, Infinity, -Infinity];
  for (let brick = 0; brick < bricks.count; brick++) {
    lowX = Math.min(lowX, bricks.foot[3 * brick]);
    highX = Math.max(highX, bricks.foot[3 * brick]);
    lowY = Math.min(lowY, bricks.foot[3 * brick + 1]);
    highY = Math.max(highY, bricks.foot[3 * brick + 1]);
  }
  const margin = 0.06;
  const scale = Math.min(canvas.width / (highX - lowX + 2 * margin), canvas.height / (highY - lowY + 2 * margin));
  const x = (value: number): number => canvas.width / 2 + scale * (value - 0.5 * (lowX + highX));
  const y = (value: number): number => canvas.height / 2 - scale * (value - 0.5 * (lowY + highY));
  const step = Math.max(1, Math.floor(bricks.count / 4000));
  for (let brick = 0; brick < bricks.count; brick += step) {
    const pose = poseOf(brick);
    const hull = hullOf(cornersOf(pose, halfExtents(recording, brick)));
    pen.beginPath();
    hull.forEach(([px, py], i) => (i ? pen.lineTo(x(px), y(py)) : pen.moveTo(x(px), y(py))));
    pen.closePath();
    pen.fillStyle = pen.strokeStyle = colors[bricks.color[brick]];
    pen.lineWidth = 1;
    pen.stroke();
    pen.fill();
    if (scale < 0.25 * ratio * 1000) continue; // an outline would hide so small a brick
    pen.strokeStyle = 'rgb(0 0 0 / 35%)';
    pen.lineWidth = 0.7 * ratio;
    pen.stroke();
  }
}

function cornersOf(pose: Pose, half: readonly number[]): [number, number][] {
  const { qw: w, qx, qy, qz } = pose;
  return kCorners.map(([a, b, c]) => {
    const [vx, vy, vz] = [a * half[0], b * half[1], c * half[2]];
    const tx = 2 * (qy * vz - qz * vy);
    const ty = 2 * (qz * vx - qx * vz);
    const tz = 2 * (qx * vy - qy * vx);
    return [pose.x + vx + w * tx + qy * tz - qz * ty, pose.y + vy + w * ty + qz * tx - qx * tz];
  });
}

/** The convex outline of a few points (Andrew's chain). */
function hullOf(points: [number, number][]): [number, number][] {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const turn = (o: number[], a: number[], b: number[]): number => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
  const chain = (all: [number, number][]): [number, number][] => {
    const out: [number, number][] = [];
    for (const p of all) {
      while (out.length >= 2 && turn(out[out.length - 2], out[out.length - 1], p) <= 0) out.pop();
      out.push(p);
    }
    return out.slice(0, -1);
  };
  return [...chain(sorted), ...chain(sorted.reverse())];
}
