/** What was measured, as the page shows it beside a run. */

import { fileURLToPath } from 'node:url';
import { describe, expect, test } from 'vitest';
import { readPublished } from '../../published.ts';
import { decodeRecording } from '../../src/recording/decode.ts';
import { bandOf, publishedSpeed, type PublishedSource } from '../../src/recording/published.ts';
import { findFront } from '../../src/recording/wave.ts';
import { makeRecording } from '../make_recording.ts';

const sources = readPublished(fileURLToPath(new URL('../../../validation', import.meta.url)));
const named = (word: string): PublishedSource => sources.find(({ name }) => name.includes(word))!;
const speedOf = (source: PublishedSource, gap: number): [number, number] | null => publishedSpeed(source, 0.048, 0.0075, gap);

describe('what was published', () => {
  test('the sources whose figures say gap and speed are there, in the words of their titles', () => {
    expect(sources.map(({ x, y }) => `${x} ${y}`)).toEqual(expect.arrayContaining(['gap speed', 'pitch_per_height speed_per_root', 'gap_per_height speed_per_root', 'gap time_per_brick']));
    for (const { name, series } of sources) {
      expect(name).toMatch(/\S/);
      for (const { x, low, high } of series) for (let i = 0; i < x.length; i++) expect(high[i]).toBeGreaterThanOrEqual(low[i]);
    }
  });

  test('a speed measured at a gap is between its bars, in every reading', () => {
    // Toronto, 15 mm: 0.867 ± 0.010 m/s on the table, 0.573 ± 0.006 on sandpaper; each also read 20 % lower.
    const [low, high] = speedOf(named('Toronto'), 0.015)!;
    expect(low).toBeCloseTo(0.8 * (0.573 - 0.006), 9);
    expect(high).toBeCloseTo(0.867 + 0.01, 9);
    // Halfway to 7.5 mm only the table was measured: 0.877 ± 0.020 there.
    const [, halfway] = speedOf(named('Toronto'), 0.01125)!;
    expect(halfway).toBeCloseTo((0.897 + 0.877) / 2, 9);
    expect(speedOf(named('Toronto'), 0.03)).toBeNull();
  });

  test('speeds in units of the brick and times from brick to brick become metres a second', () => {
    const xiang = sources.find(({ x }) => x === 'gap_per_height')!;
    const [low, high] = publishedSpeed(xiang, 0.048, 0.0075, 0.5 * 0.048)!;
    expect(low).toBeCloseTo(0.9 * 1.109 * Math.sqrt(9.81 * 0.048), 9);
    expect(high).toBeCloseTo(1.1 * 1.109 * Math.sqrt(9.81 * 0.048), 9);
    const timed = sources.find(({ y }) => y === 'time_per_brick')!;
    const [slow, fast] = publishedSpeed(timed, 0.048, 0.0075, 0.0150876)!;
    expect(slow).toBeCloseTo((15.0876 + 7.5) / (19.97 + 0.22), 4);
    expect(fast).toBeCloseTo((15.0876 + 7.5) / (19.97 - 0.22), 4);
  });

  test('of other bricks nothing is said', () => {
    expect(publishedSpeed(named('Toronto'), 0.096, 0.015, 0.015)).toBeNull();
    expect(publishedSpeed(named('Toronto'), 0.048, 0.009, 0.015)).toBeNull();
  });

  test('a row of such bricks has a band all along', () => {
    const recording = decodeRecording(makeRecording({ count: 30 }));
    const front = findFront(recording);
    const gap = front.distance[5] - front.distance[4] - recording.kinds[0].thickness;
    const band = bandOf(recording, front, sources)!;
    expect(band.low.length).toBe(front.brick.length);
    expect(band.low[0]).toBeNull();
    const expected = sources.flatMap((source) => publishedSpeed(source, recording.kinds[0].height, recording.kinds[0].thickness, gap) ?? []);
    expect(band.low[5]).toBeCloseTo(Math.min(...expected), 6);
    expect(band.high[5]).toBeCloseTo(Math.max(...expected), 6);
  });
});
