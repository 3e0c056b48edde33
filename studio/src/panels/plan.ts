/** The run from above on a plain canvas: what is shown where there is no WebGL. */

import type { Playhead } from '../recording/playhead.ts';
import { halfExtents } from '../recording/pose.ts';
import type { Recording } from '../recording/types.ts';

export interface PlanFit {
  width: number;
  height: number;
  /** Pixels a metre. */
  scale: number;
  x(metres: number): number;
  y(metres: number): number;
  /** The brick whose foot is nearest to a pixel. */
  nearest(x: number, y: number): number;
}

/** Around the plan [px]. */
const kMargin = 40;

export function planFit(recording: Recording, width: number, height: number): PlanFit {
  const { foot, count } = recording.bricks;
  let [lowX, highX, lowY, highY] = [Infinity, -Infinity, Infinity, -Infinity];
  for (let b = 0; b < count; b++) {
    lowX = Math.min(lowX, foot[3 * b]);
    highX = Math.max(highX, foot[3 * b]);
    lowY = Math.min(lowY, foot[3 * b + 1]);
    highY = Math.max(highY, foot[3 * b + 1]);
  }
  const reach = Math.max(...recording.kinds.map((kind) => kind.height)); // of a brick that has fallen over the edge
  lowX -= reach;
  highX += reach;
  lowY -= reach;
  highY += reach;
  const scale = Math.min(
    Math.max(40, width - 2 * kMargin) / Math.max(0.1, highX - lowX),
    Math.max(40, height - 2 * kMargin) / Math.max(0.1, highY - lowY),
  );
  const x = (metres: number): number => width / 2 + (metres - (lowX + highX) / 2) * scale;
  const y = (metres: number): number => height / 2 - (metres - (lowY + highY) / 2) * scale;
  const nearest = (px: number, py: number): number => {
    let [best, least] = [-1, Infinity];
    for (let b = 0; b < count; b++) {
      const away = Math.hypot(x(foot[3 * b]) - px, y(foot[3 * b + 1]) - py);
      if (away < least) [best, least] = [b, away];
    }
    return best;
  };
  return { width, height, scale, x, y, nearest };
}

export function drawPlan(canvas: HTMLCanvasElement, playhead: Playhead, fit: PlanFit, chosen: number, dark: boolean): void {
  const ratio = devicePixelRatio || 1;
  canvas.width = Math.round(fit.width * ratio);
  canvas.height = Math.round(fit.height * ratio);
  const pen = canvas.getContext('2d');
  if (!pen) return;
  pen.scale(ratio, ratio);
  pen.lineWidth = Math.min(1, fit.scale * 0.001);
  pen.strokeStyle = dark ? 'rgb(0 0 0 / 50%)' : 'rgb(255 255 255 / 60%)';
  const { bricks, colors } = playhead.recording;
  for (let brick = 0; brick < bricks.count; brick++) {
    trace(pen, playhead, fit, brick);
    pen.fillStyle = colors[bricks.color[brick]];
    pen.fill();
    pen.stroke();
  }
  if (chosen < 0) return;
  trace(pen, playhead, fit, chosen);
  pen.lineWidth = 2;
  pen.strokeStyle = dark ? '#6cb4f5' : '#0b5cad';
  pen.stroke();
}

/** The brick's shadow straight down, however it lies. */
function trace(pen: CanvasRenderingContext2D, playhead: Playhead, fit: PlanFit, brick: number): void {
  const { position, turn, origin } = playhead;
  const half = halfExtents(playhead.recording, brick);
  const [x, y, z, w] = turn.subarray(4 * brick, 4 * brick + 4);
  const axes = half.map((size, axis) => {
    const v = [0, 0, 0];
    v[axis] = size;
    const tx = 2 * (y * v[2] - z * v[1]);
    const ty = 2 * (z * v[0] - x * v[2]);
    const tz = 2 * (x * v[1] - y * v[0]);
    return [v[0] + w * tx + y * tz - z * ty, v[1] + w * ty + z * tx - x * tz];
  });
  const [px, py] = [position[3 * brick] + origin[0], position[3 * brick + 1] + origin[1]];
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((corner): [number, number] => {
    const [dx, dy] = [0, 1].map((k) => axes.reduce((sum, axis, i) => sum + (corner & (1 << i) ? axis[k] : -axis[k]), 0));
    return [fit.x(px + dx), fit.y(py + dy)];
  });
  pen.beginPath();
  for (const [cx, cy] of hull(corners)) pen.lineTo(cx, cy);
  pen.closePath();
}

/** The convex outline of points in the plane. */
export function hull(points: [number, number][]): [number, number][] {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const side = (from: [number, number][]): [number, number][] => {
    const out: [number, number][] = [];
    for (const p of from) {
      while (out.length > 1) {
        const [[ax, ay], [bx, by]] = out.slice(-2);
        if ((bx - ax) * (p[1] - ay) - (by - ay) * (p[0] - ax) > 0) break;
        out.pop();
      }
      out.push(p);
    }
    out.pop();
    return out;
  };
  return [...side(sorted), ...side([...sorted].reverse())];
}
