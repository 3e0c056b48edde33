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

/** The brick's shadow straight down: as long along its lean as it reaches. */
function trace(pen: CanvasRenderingContext2D, playhead: Playhead, fit: PlanFit, brick: number): void {
  const { position, turn, origin } = playhead;
  const [ht, hw, hh] = halfExtents(playhead.recording, brick);
  const [x, y, z, w] = turn.subarray(4 * brick, 4 * brick + 4);
  const along = (v: [number, number, number]): [number, number] => {
    const tx = 2 * (y * v[2] - z * v[1]);
    const ty = 2 * (z * v[0] - x * v[2]);
    const tz = 2 * (x * v[1] - y * v[0]);
    return [v[0] + w * tx + y * tz - z * ty, v[1] + w * ty + z * tx - x * tz];
  };
  const [a, b, c] = [along([ht, 0, 0]), along([0, hw, 0]), along([0, 0, hh])];
  const reach: [number, number] = [a[0] + Math.sign(a[0] * c[0] + a[1] * c[1] || 1) * c[0], a[1] + Math.sign(a[0] * c[0] + a[1] * c[1] || 1) * c[1]];
  const [px, py] = [position[3 * brick] + origin[0], position[3 * brick + 1] + origin[1]];
  pen.beginPath();
  for (const [i, j] of [[1, 1], [1, -1], [-1, -1], [-1, 1]]) pen.lineTo(fit.x(px + i * reach[0] + j * b[0]), fit.y(py + i * reach[1] + j * b[1]));
  pen.closePath();
}
