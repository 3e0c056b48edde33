/** Heat: bricks coloured by when the wave reached them, dark blue first and yellow last; those it never reached are grey. */

import type { Loaded } from '../recording/load.ts';
import { EventKind } from '../recording/types.ts';

/** Stops of a map that is even to the eye and safe for the colour-blind (after cividis). */
const kHeat = [[0, 34, 78], [66, 78, 108], [124, 123, 120], [187, 173, 108], [254, 232, 56]];

export function heatOf({ recording }: Loaded): (brick: number) => [number, number, number] {
  const { events, bricks } = recording;
  const arrival = new Float64Array(bricks.count).fill(NaN);
  let [first, last] = [Infinity, -Infinity];
  for (let i = 0; i < events.count; i++) {
    if (events.kind[i] !== EventKind.arrived) continue;
    arrival[events.brick[i]] = events.time[i];
    first = Math.min(first, events.time[i]);
    last = Math.max(last, events.time[i]);
  }
  return (brick) => {
    if (Number.isNaN(arrival[brick])) return [150, 150, 150];
    const at = ((arrival[brick] - first) / Math.max(1e-9, last - first)) * (kHeat.length - 1);
    const i = Math.min(kHeat.length - 2, Math.floor(at));
    return kHeat[i].map((value, c) => value + (at - i) * (kHeat[i + 1][c] - value)) as [number, number, number];
  };
}
