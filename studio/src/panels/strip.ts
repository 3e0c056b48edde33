/** Draws the still parts of the timeline: the front's way, the ribbon in the bricks' colours, ticks, marks and seconds. */

import type { Loaded } from '../recording/load.ts';
import { EventKind } from '../recording/types.ts';
import { lastNotOver } from '../recording/wave.ts';

/** A moment with a name. */
export interface Mark {
  time: number;
  words: string;
  kind: 'plain' | 'chosen' | 'warn';
}

export interface StripLook {
  width: number;
  /** Of the front's part [px]. */
  height: number;
  /** Seconds over its width: the recording's, or more while it grows. */
  span: number;
  colors: { well: string; line: string; ink: string; accent: string; soft: string };
}

const kRibbonGap = 4;
const kRibbon = 8;

export function stripHeight(height: number): number {
  return height + kRibbonGap + kRibbon;
}

/** Seconds between two numbers on the axis, so that they stand at least `room` pixels apart: 1, 2 or 5 times a power of ten. */
export function axisStep(duration: number, width: number, room: number): number {
  const least = (duration * room) / Math.max(1, width);
  const power = 10 ** Math.floor(Math.log10(least));
  return power * ([1, 2, 5, 10].find((m) => m * power >= least) ?? 10);
}

/** @param passed Draws the part before the playhead: filled, in the accent. */
export function drawStrip(canvas: HTMLCanvasElement, loaded: Loaded, look: StripLook, passed: boolean): void {
  const ratio = Math.min(3, devicePixelRatio || 1);
  const { width, height, colors } = look;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(stripHeight(height) * ratio);
  const pen = canvas.getContext('2d');
  if (!pen) return;
  pen.scale(ratio, ratio);
  const x = (time: number): number => (time / look.span) * width;
  if (!passed) {
    pen.fillStyle = colors.well;
    rounded(pen, 0, 0, width, height, 4);
    drawRibbon(pen, loaded, look, height + kRibbonGap);
  }
  drawFront(pen, loaded, x, look, passed);
  drawTicks(pen, loaded, x, look);
}

function rounded(pen: CanvasRenderingContext2D, x: number, y: number, width: number, height: number, radius: number): void {
  pen.beginPath();
  pen.roundRect(x, y, width, height, radius);
  pen.fill();
}

function drawFront(pen: CanvasRenderingContext2D, { front, recording }: Loaded, x: (t: number) => number, look: StripLook, passed: boolean): void {
  const { height, colors } = look;
  const y = (distance: number): number => height - 1 - (distance / (front.length || 1)) * (height - 20);
  const step = Math.max(1, Math.floor(front.time.length / (2 * look.width)));
  pen.beginPath();
  pen.moveTo(0, y(0));
  for (let i = 0; i < front.time.length; i += step) pen.lineTo(x(front.time[i]), y(front.distance[i]));
  if (front.time.length) {
    pen.lineTo(x(front.time[front.time.length - 1]), y(front.length));
    pen.lineTo(x(recording.duration), y(front.length));
  } else pen.lineTo(x(recording.duration), y(0));
  pen.strokeStyle = passed ? colors.accent : colors.line;
  pen.lineWidth = passed ? 2 : 1.5;
  pen.stroke();
  if (!passed) return;
  pen.lineTo(x(recording.duration), height);
  pen.lineTo(0, height);
  pen.closePath();
  pen.fillStyle = colors.soft;
  pen.fill();
}

/** Under each moment the colour of the brick that the wave reached last. */
function drawRibbon(pen: CanvasRenderingContext2D, { front, recording }: Loaded, { width, span, colors }: StripLook, top: number): void {
  pen.fillStyle = colors.well;
  rounded(pen, 0, top, width, kRibbon, 4);
  if (front.time.length === 0) return;
  pen.save();
  pen.beginPath();
  pen.roundRect(0, top, width, kRibbon, 4);
  pen.clip();
  const first = (front.time[0] / span) * width;
  // Of a run that still grows, the front may be further than what can be shown.
  const last = Math.min(width, (front.time[front.time.length - 1] / span) * width);
  if (!Number.isFinite(first + last)) return;
  for (let at = Math.floor(first); at <= Math.max(first + 2, last); at++) {
    const i = Math.max(0, lastNotOver(front.time, (at / width) * span));
    pen.fillStyle = recording.colors[recording.bricks.color[front.brick[i]]];
    pen.fillRect(at, top, 1.5, kRibbon);
  }
  pen.restore();
}

/** Every fifth brick that was struck, or fewer where they would run together. */
function drawTicks(pen: CanvasRenderingContext2D, { recording }: Loaded, x: (t: number) => number, look: StripLook): void {
  const { events } = recording;
  let struck = 0;
  let last = -Infinity;
  pen.fillStyle = look.colors.line;
  for (let i = 0; i < events.count; i++) {
    if (events.kind[i] !== EventKind.struck || struck++ % 5) continue;
    const at = x(events.time[i]);
    if (at - last < 3) continue;
    last = at;
    pen.fillRect(Math.round(at), look.height - 4, 1, 4);
  }
}

/** Push, chosen brick struck, where the wave died, last landing. */
export function marksOf({ recording }: Loaded, chosen: number, struckAt: number): Mark[] {
  const { events, pushes, end } = recording;
  const marks: Mark[] = pushes.slice(0, 20).map((push) => ({ time: push.at, words: 'Pushed', kind: 'plain' }));
  let landed = NaN;
  for (let i = events.count - 1; i >= 0 && Number.isNaN(landed); i--) {
    if (events.kind[i] === EventKind.landed) landed = events.time[i];
  }
  if (!Number.isNaN(landed)) marks.push({ time: landed, words: `Last landed, ${landed.toFixed(2)} s`, kind: 'plain' });
  if (end.reason === 3) {
    const lastArrival = marksArrival(events.time, events.kind);
    marks.push({ time: lastArrival, words: `Wave died, ${lastArrival.toFixed(2)} s`, kind: 'warn' });
  }
  if (chosen >= 0 && Number.isFinite(struckAt)) marks.push({ time: struckAt, words: `${chosen} struck, ${struckAt.toFixed(3)} s`, kind: 'chosen' });
  return marks;
}

function marksArrival(times: Float64Array, kinds: Uint8Array): number {
  for (let i = times.length - 1; i >= 0; i--) if (kinds[i] === EventKind.arrived || kinds[i] === EventKind.struck) return times[i];
  return 0;
}
