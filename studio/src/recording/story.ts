/** One brick's story for the inspector: its events, the curves of its motion, and what it does now. */

import { turnBetweenKnots, type Turn } from './hermite.ts';
import { isMoving, trackAt, turnAt } from './motion.ts';
import { extentsOf, tipAngle } from './pose.ts';
import { EventKind, kNoBrick, type Recording } from './types.ts';

/** Which events speak of which brick, as the one it happens to or the one that does it. */
export class EventIndex {
  private readonly firstOf: Uint32Array;
  private readonly order: Uint32Array;

  constructor(private readonly recording: Recording) {
    const { bricks, events } = recording;
    this.firstOf = new Uint32Array(bricks.count + 1);
    const each = (visit: (brick: number, event: number) => void): void => {
      for (let i = 0; i < events.count; i++) {
        visit(events.brick[i], i);
        if (events.by[i] !== kNoBrick && events.by[i] !== events.brick[i]) visit(events.by[i], i);
      }
    };
    each((brick) => this.firstOf[brick + 1]++);
    for (let b = 0; b < bricks.count; b++) this.firstOf[b + 1] += this.firstOf[b];
    this.order = new Uint32Array(this.firstOf[bricks.count]);
    const used = this.firstOf.slice(0, bricks.count);
    each((brick, event) => (this.order[used[brick]++] = event));
  }

  /** Event numbers in the order of time. */
  of(brick: number): Uint32Array {
    return this.order.subarray(this.firstOf[brick], this.firstOf[brick + 1]);
  }

  /** First event of a sort that happens to a brick, -1 if none does. */
  first(brick: number, kind: EventKind): number {
    const { events } = this.recording;
    for (const i of this.of(brick)) if (events.kind[i] === kind && events.brick[i] === brick) return i;
    return -1;
  }

  /** Bricks that a brick strikes, with the first event of each. */
  strikes(brick: number): number[] {
    const { events } = this.recording;
    const seen = new Set<number>();
    return Array.from(this.of(brick)).filter((i) => {
      if (events.kind[i] !== EventKind.struck || events.by[i] !== brick || seen.has(events.brick[i])) return false;
      seen.add(events.brick[i]);
      return true;
    });
  }
}

/** Words with, perhaps, a brick to link to. */
export interface Doing {
  words: string;
  brick: number;
}

/** What a brick does at a time [s]. */
export function doingAt(recording: Recording, index: EventIndex, brick: number, time: number): Doing {
  const { events } = recording;
  if (trackAt(recording, brick, time) < 0) return { words: 'standing', brick: kNoBrick };
  let leansOn = kNoBrick;
  let landed = false;
  for (const i of index.of(brick)) {
    if (events.time[i] > time || events.brick[i] !== brick || events.kind[i] !== EventKind.landed) continue;
    landed = true;
    leansOn = events.by[i];
  }
  const turn: Turn = { angle: 0, rate: 0, acceleration: 0 };
  turnAt(recording, brick, time, turn);
  const tipped = Math.abs(turn.angle) > tipAngle(extentsOf(recording, brick));
  const moving = isMoving(recording, brick, time);
  if (moving && landed && leansOn !== kNoBrick) return { words: 'falling, leaning on', brick: leansOn };
  if (moving) return { words: tipped ? 'falling' : turn.rate < 0 === turn.angle > 0 ? 'falling back' : 'tipping', brick: kNoBrick };
  if (!tipped) return { words: 'standing again', brick: kNoBrick };
  if (landed && leansOn !== kNoBrick) return { words: 'at rest, leaning on', brick: leansOn };
  return { words: 'at rest on the table', brick: kNoBrick };
}

/** Curves of one brick's motion: x in seconds, angle in degrees, rate in rad/s, acceleration in rad/s²; null where a curve breaks. */
export interface Curves {
  time: number[];
  angle: (number | null)[];
  rate: (number | null)[];
  acceleration: (number | null)[];
  /** Times at which rate or acceleration jump [s]. */
  jumps: number[];
}

const kDegrees = 180 / Math.PI;
/** Points drawn between two knots: enough that a turnBetweenKnots looks smooth at the width of a panel. */
const kPointsBetween = 6;

/** @returns null for a brick that never moves. */
export function curvesOf(recording: Recording, brick: number): Curves | null {
  const { tracks } = recording;
  const first = tracks.firstOf[brick];
  const last = tracks.firstOf[brick + 1];
  if (first === last) return null;
  const out: Curves = { time: [], angle: [], rate: [], acceleration: [], jumps: [] };
  let rest = 0;
  for (let track = first; track < last; track++) {
    const before = track === first ? Math.max(0, tracks.start[first] - 10) : tracks.end[track - 1];
    addPoint(out, before, rest, 0, 0);
    addPoint(out, tracks.start[track], rest, 0, 0);
    addBreak(out, tracks.start[track]);
    if (tracks.free[track]) addFree(recording, brick, track, out);
    else addHinged(recording, track, out);
    rest = (out.angle.at(-1) ?? 0) / kDegrees;
    addBreak(out, tracks.end[track]);
  }
  addPoint(out, tracks.end[last - 1], rest, 0, 0);
  addPoint(out, Math.max(recording.duration, tracks.end[last - 1]), rest, 0, 0);
  return out;
}

function addPoint(out: Curves, time: number, angle: number, rate: number, acceleration: number): void {
  out.time.push(time);
  out.angle.push(angle * kDegrees);
  out.rate.push(rate);
  out.acceleration.push(acceleration);
}

/** Rate and acceleration break; the angle goes on. */
function addBreak(out: Curves, time: number): void {
  out.time.push(time);
  out.angle.push(out.angle.at(-1) ?? null);
  out.rate.push(null);
  out.acceleration.push(null);
  out.jumps.push(time);
}

function addHinged(recording: Recording, track: number, out: Curves): void {
  const { tracks, hinged } = recording;
  const first = tracks.firstKnot[track];
  const count = tracks.knotCount[track];
  const start = tracks.start[track];
  const turn: Turn = { angle: 0, rate: 0, acceleration: 0 };
  const { time, angle, rate, acceleration } = hinged;
  for (let k = first; k < first + count; k++) {
    addPoint(out, start + time[k], angle[k], rate[k], acceleration[k]);
    if (k + 1 === first + count) break;
    const h = time[k + 1] - time[k];
    if (h <= 0) {
      addBreak(out, start + time[k]);
      continue;
    }
    for (let i = 1; i < kPointsBetween; i++) {
      const s = i / kPointsBetween;
      turnBetweenKnots(s, h, angle[k], rate[k], acceleration[k], angle[k + 1], rate[k + 1], acceleration[k + 1], turn);
      addPoint(out, start + time[k] + s * h, turn.angle, turn.rate, turn.acceleration);
    }
  }
}

function addFree(recording: Recording, brick: number, track: number, out: Curves): void {
  const { tracks, free } = recording;
  const first = tracks.firstKnot[track];
  const turn: Turn = { angle: 0, rate: 0, acceleration: 0 };
  for (let k = first; k < first + tracks.knotCount[track] - 1; k++) {
    const h = free.time[k + 1] - free.time[k];
    for (let i = 0; i < kPointsBetween && h > 0; i++) {
      const time = tracks.start[track] + free.time[k] + (i / kPointsBetween) * h;
      turnAt(recording, brick, time, turn);
      addPoint(out, time, turn.angle, turn.rate, turn.acceleration);
    }
  }
}

/** The part of a brick's curves worth a plot [s]: from a little before it wakes until its angle has all but settled. */
export function motionWindow(curves: Curves): [number, number] {
  const { time, angle, jumps } = curves;
  const final = angle.at(-1) ?? 0;
  const most = Math.max(...angle.map((a) => Math.abs((a ?? final) - final)));
  const from = jumps[0];
  let settled = angle.length - 1;
  while (settled > 0 && Math.abs((angle[settled] ?? final) - final) <= 0.004 * most) settled--;
  const to = Math.max(time[Math.min(settled + 1, time.length - 1)], from + 0.02);
  const margin = 0.08 * (to - from);
  return [Math.max(0, from - margin), to + margin];
}
