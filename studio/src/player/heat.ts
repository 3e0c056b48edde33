/**
 * Heat: bricks coloured by when the wave reached them, how fast it was there, how hard they were hit, or how often it stops at them where
 * they are put down by hand; those without a value are grey.
 */

import type { Risk } from '../engine/engine.ts';
import type { Loaded } from '../recording/load.ts';
import { EventKind, type Recording } from '../recording/types.ts';
import { runDistances } from '../recording/wave.ts';

export type HeatSort = 'arrival' | 'speed' | 'impulse' | 'risk';

/** Stops of a map that is even to the eye and safe for the colour-blind (after cividis). */
const kHeat = [[0, 34, 78], [66, 78, 108], [124, 123, 120], [187, 173, 108], [254, 232, 56]];

/** How many strikers back the speed of the wave at a brick is taken over. */
const kBack = 3;

/** Of the wave where it passed each brick [m/s], along whichever branch it came. */
function speedsOf(recording: Recording): Float64Array {
  const { events, bricks } = recording;
  const along = runDistances(recording);
  const striker = new Int32Array(bricks.count).fill(-1);
  const arrival = new Float64Array(bricks.count).fill(NaN);
  for (let i = 0; i < events.count; i++) {
    const brick = events.brick[i];
    if (events.kind[i] === EventKind.struck && striker[brick] < 0 && events.by[i] < bricks.count) striker[brick] = events.by[i];
    if (events.kind[i] === EventKind.arrived && Number.isNaN(arrival[brick])) arrival[brick] = events.time[i];
  }
  return Float64Array.from({ length: bricks.count }, (_, brick) => {
    let from = brick;
    for (let k = 0; k < kBack && striker[from] >= 0; k++) from = striker[from];
    const spent = arrival[brick] - arrival[from];
    return spent > 0 ? (along[brick] - along[from]) / spent : NaN;
  });
}

/** Share of the runs that come to a brick in which it stops them; 0 for those that never did. */
function stopsOf(recording: Recording, risk: Risk | null): Float64Array {
  const { events, bricks } = recording;
  const values = new Float64Array(bricks.count).fill(NaN);
  for (let i = 0; i < events.count; i++) if (events.kind[i] === EventKind.arrived) values[events.brick[i]] = 0;
  for (const { brick, stops } of risk?.weak ?? []) values[brick] = stops.count / stops.of;
  return values;
}

function valuesOf({ recording }: Loaded, sort: HeatSort, risk: Risk | null): Float64Array {
  const { events, bricks } = recording;
  if (sort === 'speed') return speedsOf(recording);
  if (sort === 'risk') return stopsOf(recording, risk);
  const values = new Float64Array(bricks.count).fill(NaN);
  for (let i = 0; i < events.count; i++) {
    const brick = events.brick[i];
    if (sort === 'arrival' && events.kind[i] === EventKind.arrived) values[brick] = events.time[i];
    if (sort === 'impulse' && Number.isFinite(events.impulse[i])) values[brick] = Math.max(values[brick] || 0, events.impulse[i]);
  }
  return values;
}

/** @param risk Of the sort `risk`: what many runs came to. */
export function heatOf(loaded: Loaded, sort: HeatSort = 'arrival', risk: Risk | null = null): (brick: number) => [number, number, number] {
  const values = valuesOf(loaded, sort, risk);
  const known = Float64Array.from(values.filter((value) => Number.isFinite(value))).sort();
  // Speeds have outliers at the push and in bends: the middle 96 % take the whole range.
  const at = (part: number): number => known[Math.floor(part * (known.length - 1))] ?? 0;
  const [low, high] = sort === 'arrival' || sort === 'risk' ? [at(0), at(1)] : [at(0.02), at(0.98)];
  return (brick) => {
    if (!Number.isFinite(values[brick])) return [150, 150, 150];
    const place = Math.min(1, Math.max(0, (values[brick] - low) / Math.max(1e-9, high - low))) * (kHeat.length - 1);
    const i = Math.min(kHeat.length - 2, Math.floor(place));
    return kHeat[i].map((value, c) => value + (place - i) * (kHeat[i + 1][c] - value)) as [number, number, number];
  };
}
