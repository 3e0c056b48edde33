/**
 * A made-up recording of a row or an S-curve: not physics, but bricks that lean on one another exactly
 * (h sin(b - f) = p cos f - t for tilts b and f of two neighbours), and every piece of docs/format.md.
 */

import { joinBytes, PieceWriter } from './piece_writer.ts';

export interface Made {
  count: number;
  shape?: 'row' | 's_curve';
  /** Foot to foot [m]. */
  pitch?: number;
  /** Colours run through the spectrum; otherwise all are one. */
  spectrum?: boolean;
}

const kHeight = 0.048;
const kWidth = 0.024;
const kThickness = 0.0075;
/** Time from one hit to the next [s]. */
export const kHitStep = 0.0254;
/** Between two knots [s]. */
const kKnotStep = 0.004;
/** How long the last brick takes to the floor [s]. */
const kLastFall = 0.09;

interface Placed {
  x: number;
  y: number;
  heading: number;
}

function place(made: Made, pitch: number): Placed[] {
  const out: Placed[] = [];
  let [x, y, heading] = [0, 0, 0];
  for (let i = 0; i < made.count; i++) {
    out.push({ x, y, heading });
    if (made.shape === 's_curve') heading = 1.35 * Math.sin((2 * Math.PI * i) / Math.max(40, made.count / 2));
    x += pitch * Math.cos(heading);
    y += pitch * Math.sin(heading);
  }
  return out;
}

/** Tilt of a brick that leans on one with tilt `front`. */
export function leaning(front: number, pitch: number): number {
  return front + Math.asin(Math.min(1, (pitch * Math.cos(front) - kThickness) / kHeight));
}

/** Tilts of all bricks at a time, from the front of the wave backwards [rad]. */
export function tiltsAt(count: number, pitch: number, time: number): Float64Array {
  const tilts = new Float64Array(count);
  const contact = Math.asin((pitch - kThickness) / kHeight);
  const last = count - 1;
  const front = Math.min(last, Math.floor(time / kHitStep));
  if (time < 0) return tilts;
  const since = time - front * kHitStep;
  tilts[front] = (contact * since) / kHitStep;
  if (front === last && since > kHitStep) {
    const part = Math.min(1, (since - kHitStep) / kLastFall);
    const rate = (contact / kHitStep) * kLastFall;
    tilts[last] = Math.min(Math.PI / 2, contact + rate * part + (Math.PI / 2 - contact - rate) * part * part);
  }
  for (let i = front - 1; i >= Math.max(0, front - 60); i--) tilts[i] = leaning(tilts[i + 1], pitch);
  for (let i = front - 61; i >= 0; i--) tilts[i] = tilts[i + 1];
  return tilts;
}

function hue(part: number): [number, number, number] {
  const stops = [[212, 26, 40], [240, 130, 30], [245, 190, 40], [60, 170, 70], [20, 150, 200], [30, 80, 200], [120, 50, 190]];
  const at = part * (stops.length - 1);
  const i = Math.min(stops.length - 2, Math.floor(at));
  return stops[i].map((value, c) => Math.round(value + (at - i) * (stops[i + 1][c] - value))) as [number, number, number];
}

export function makeRecording(made: Made): Uint8Array {
  const pitch = made.pitch ?? 0.024;
  const placed = place(made, pitch);
  const colors = made.spectrum === false ? [[192, 57, 43]] : placed.map((_, i) => hue(i / Math.max(1, made.count - 1)));
  const end = made.count * kHitStep + kLastFall;
  const pieces: Uint8Array[] = [new TextEncoder().encode('TOPPLE01')];
  pieces.push(
    new PieceWriter().string('0.1.0').string('pivot').string('made.toml').string('# made up').f64(0.0005).u32(0).piece('RCPE'),
    scenePiece(made, colors),
    brickPiece(placed, colors.length),
    trackPiece(made.count, pitch, end),
    eventPiece(made.count, pitch, end),
    energyPiece(made.count, pitch, end),
    new PieceWriter().u64(1n).u64(1n).array(BigUint64Array.of(7n)).piece('HASH'),
    new PieceWriter().u32(1).u32(0xffffffff).u64(BigInt(Math.round(end / 0.0005))).f64(end).u64(0x7f3a91c2n).string('All bricks are at rest.').piece('END_'),
  );
  return joinBytes(pieces);
}

function scenePiece(made: Made, colors: number[][]): Uint8Array {
  const piece = new PieceWriter().string(made.shape === 's_curve' ? 'S-curve' : 'A row').f64(9.81).f64(0.002);
  piece.u32(1).string('domino');
  for (const value of [kHeight, kWidth, kThickness, 0.0085, 0.2, 0.5, 0, 0]) piece.f64(value);
  piece.u8(192).u8(57).u8(43).u32(colors.length);
  for (const color of colors) for (const part of color) piece.u8(part);
  piece.u32(1).string('row 1').u32(0).u32(made.count);
  piece.u32(1).u32(0).f64(0).u8(0).f64(4).f64(0).f64(0);
  return piece.piece('SCEN');
}

function brickPiece(placed: Placed[], colors: number): Uint8Array {
  const piece = new PieceWriter().u32(0).u32(placed.length);
  piece.f64s(placed.map((p) => p.x)).f64s(placed.map((p) => p.y)).f64s(placed.map(() => 0)).f64s(placed.map((p) => p.heading));
  piece.u16s(placed.map(() => 0)).u16s(placed.map((_, i) => i % colors)).u8s(placed.map(() => 0));
  return piece.piece('BRIK');
}

/** Each brick from its hit until all rest; derivatives of the knots by differences, one jump of the rate at the hit. */
function trackPiece(count: number, pitch: number, end: number): Uint8Array {
  const samples = Math.ceil(end / kKnotStep) + 1;
  const grid: Float64Array[] = [];
  for (let k = 0; k <= samples; k++) grid.push(tiltsAt(count, pitch, Math.min(end, k * kKnotStep)));
  const [starts, bricks, counts]: number[][] = [[], [], []];
  const [times, angles, rates, accelerations]: number[][] = [[], [], [], []];
  const knot = (time: number, angle: number, rate: number): void => {
    times.push(time);
    angles.push(angle);
    rates.push(rate);
    accelerations.push(0);
  };
  const hitRate = Math.asin((pitch - kThickness) / kHeight) / kHitStep;
  for (let brick = 0; brick < count; brick++) {
    const start = brick * kHitStep;
    const before = times.length;
    knot(0, 0, 0);
    knot(0, 0, hitRate);
    for (let k = Math.ceil(start / kKnotStep + 0.2); k < samples; k++) {
      const resting = grid[k][brick] === grid[samples][brick];
      const rate = resting ? 0 : (grid[k + 1][brick] - grid[k - 1][brick]) / (2 * kKnotStep);
      knot(k * kKnotStep - start, grid[k][brick], rate);
      if (resting) break;
    }
    starts.push(start);
    bricks.push(brick);
    counts.push(times.length - before);
  }
  const piece = new PieceWriter().u32(count).u32(times.length).f64s(starts).u32s(bricks).u32s(counts);
  return piece.f32s(times).f32s(angles).f32s(rates).f32s(accelerations).piece('HING');
}

function eventPiece(count: number, pitch: number, end: number): Uint8Array {
  const contact = Math.asin((pitch - kThickness) / kHeight);
  const events: { time: number; brick: number; by: number; kind: number; z: number }[] = [];
  const none = 0xffffffff;
  for (let brick = 0; brick < count; brick++) {
    const start = brick * kHitStep;
    if (brick === 0) events.push({ time: 0, brick, by: none, kind: 0, z: NaN });
    else {
      events.push({ time: start, brick, by: brick - 1, kind: 1, z: kHeight * Math.cos(contact) });
      events.push({ time: start, brick: brick - 1, by: brick, kind: 3, z: NaN });
    }
    events.push({ time: start + (kHitStep * (Math.PI / 18)) / contact, brick, by: none, kind: 2, z: NaN });
  }
  events.push({ time: end, brick: count - 1, by: none, kind: 3, z: NaN });
  events.sort((a, b) => a.time - b.time);
  const nan = events.map(() => NaN);
  const piece = new PieceWriter().u32(events.length).u32(0).f64s(events.map((e) => e.time)).u32s(events.map((e) => e.brick));
  piece.u32s(events.map((e) => e.by)).u8s(events.map((e) => e.kind)).f32s(nan).f32s(nan);
  return piece.f32s(nan).f32s(nan).f32s(events.map((e) => e.z)).piece('EVNT');
}

function energyPiece(count: number, pitch: number, end: number): Uint8Array {
  const times = Array.from({ length: 200 }, (_, i) => (end * i) / 199);
  const weight = 0.0085 * 9.81;
  const potential = times.map((time) => {
    let sum = 0;
    for (const tilt of tiltsAt(count, pitch, time)) {
      sum += 0.5 * weight * (kHeight * (Math.cos(tilt) - 1) + kThickness * Math.sin(tilt));
    }
    return sum;
  });
  const kinetic = times.map((time) => (time < end ? 0.0008 : 0));
  const work = times.map(() => 0.00006);
  return new PieceWriter().u32(200).u32(0).f64s(times).f64s(kinetic).f64s(potential).f64s(work).piece('ENRG');
}
