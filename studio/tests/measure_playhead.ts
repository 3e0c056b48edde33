/**
 * What a frame costs the page's own code at N bricks, without a browser: `npx vite-node tests/measure_playhead.ts`.
 * Plays a row at 60 frames a second of its own time, then scrubs far. Prints the median and the 99th percentile [ms].
 */

import { decodeRecording } from '../src/recording/decode.ts';
import { Playhead } from '../src/recording/playhead.ts';
import { kHitStep, makeRecording } from './make_recording.ts';
import { repeatRecording } from './repeat_recording.ts';

for (const count of [1000, 10_000, 100_000]) {
  const bytes = repeatRecording(makeRecording({ count: 400 }), count, kHitStep);
  const began = performance.now();
  const recording = decodeRecording(bytes);
  const decoded = performance.now();
  const playhead = new Playhead(recording);
  const built = performance.now();
  const costs: number[] = [];
  let moving = 0;
  const start = 0.4 * recording.duration;
  playhead.moveTo(start - 1 / 60);
  for (let frame = 0; frame < 600; frame++) {
    const t0 = performance.now();
    playhead.moveTo(start + frame / 60);
    costs.push(performance.now() - t0);
    moving = Math.max(moving, playhead.touchedCount);
  }
  costs.sort((a, b) => a - b);
  const far = performance.now();
  playhead.moveTo(recording.duration);
  playhead.moveTo(0);
  const scrubbed = (performance.now() - far) / 2;
  const ms = (value: number): string => value.toFixed(3);
  console.log(
    `${count} bricks, ${(bytes.length / 1e6).toFixed(1)} MB: decode ${ms(decoded - began)} ms, index ${ms(built - decoded)} ms, ` +
      `frame median ${ms(costs[300])} ms, 99 % ${ms(costs[594])} ms (at most ${moving} bricks touched), far scrub ${ms(scrubbed)} ms`,
  );
}
