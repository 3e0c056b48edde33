/** What was measured on rows of bricks like those of a run: between which speeds the front should be, along its way. */

import type { Recording } from './types.ts';
import type { Front } from './wave.ts';

export type PublishedX = 'gap' | 'pitch_per_height' | 'gap_per_height';
/** m/s; in units of the root of g times the height; ms from brick to brick. */
export type PublishedY = 'speed' | 'speed_per_root' | 'time_per_brick';

/** One publication: rows of one sort of brick at several gaps (mm, or parts of the height). */
export interface PublishedSource {
  name: string;
  x: PublishedX;
  y: PublishedY;
  /** [m] */
  height: number;
  thickness: number;
  series: { x: number[]; low: number[]; high: number[] }[];
}

export interface Band {
  /** One entry for each of the front's bricks [m/s]; null: nothing was published of such a brick and gap. */
  low: (number | null)[];
  high: (number | null)[];
  /** Whose measurements they are. */
  names: string[];
}

/** A brick is like the measured one if its sizes (or, in units of the height, its thickness) differ by no more than this. */
const kAlike = 0.02;
const kGravity = 9.81;

const alike = (a: number, b: number): boolean => Math.abs(a - b) <= kAlike * b;

function fits(source: PublishedSource, height: number, thickness: number): boolean {
  if (source.x === 'gap') return alike(height, source.height) && alike(thickness, source.thickness);
  return alike(thickness / height, source.thickness / source.height);
}

/** Between two measured gaps on the straight line between them; outside them nothing. */
function between(x: readonly number[], y: readonly number[], at: number): number {
  let [below, above] = [-1, -1];
  for (let i = 0; i < x.length; i++) {
    if (x[i] <= at && (below < 0 || x[i] > x[below])) below = i;
    if (x[i] >= at && (above < 0 || x[i] < x[above])) above = i;
  }
  if (below < 0 || above < 0) return NaN;
  return x[above] === x[below] ? y[below] : y[below] + ((at - x[below]) / (x[above] - x[below])) * (y[above] - y[below]);
}

/** Lowest and highest front speed of a source at a gap [m/s]; null where it says nothing. */
export function publishedSpeed(source: PublishedSource, height: number, thickness: number, gap: number): [number, number] | null {
  if (!fits(source, height, thickness)) return null;
  const at = source.x === 'gap' ? gap * 1000 : source.x === 'gap_per_height' ? gap / height : (gap + thickness) / height;
  const ends = source.series.map(({ x, low, high }) => [between(x, low, at), between(x, high, at)]).filter(([low]) => Number.isFinite(low));
  if (ends.length === 0) return null;
  const [low, high] = [Math.min(...ends.map(([a]) => a)), Math.max(...ends.map(([, b]) => b))];
  if (source.y === 'speed') return [low, high];
  if (source.y === 'time_per_brick') return [(1000 * (gap + thickness)) / high, (1000 * (gap + thickness)) / low];
  const unit = Math.sqrt(kGravity * height);
  return [low * unit, high * unit];
}

/** The band along a front: from brick to brick by the gap between them. Null: nothing was published of any of it. */
export function bandOf(recording: Recording, front: Front, sources: readonly PublishedSource[]): Band | null {
  const { bricks, kinds } = recording;
  const names = new Set<string>();
  const [low, high] = [new Array<number | null>(front.brick.length).fill(null), new Array<number | null>(front.brick.length).fill(null)];
  for (let i = 1; i < front.brick.length; i++) {
    const kind = bricks.kind[front.brick[i]];
    if (bricks.kind[front.brick[i - 1]] !== kind || kinds[kind].ball || bricks.stance[front.brick[i]] !== 0) continue;
    const { height, thickness } = kinds[kind];
    const gap = front.distance[i] - front.distance[i - 1] - thickness;
    for (const source of sources) {
      const speeds = publishedSpeed(source, height, thickness, gap);
      if (!speeds) continue;
      names.add(source.name);
      low[i] = Math.min(low[i] ?? Infinity, speeds[0]);
      high[i] = Math.max(high[i] ?? -Infinity, speeds[1]);
    }
  }
  return names.size ? { low, high, names: [...names] } : null;
}
