/** What is sent to the graphics card of the bricks that moved. */

import { expect, test } from 'vitest';
import { runsOf } from '../../src/view/bricks.ts';

/** Bricks that no run covers, and how many are covered. */
function covered(runs: { first: number; last: number }[], moved: Uint32Array): { missed: number; sent: number } {
  const missed = moved.filter((brick) => !runs.some(({ first, last }) => first <= brick && brick <= last)).length;
  return { missed, sent: runs.reduce((sum, { first, last }) => sum + last - first + 1, 0) };
}

test('a few that moved are sent in runs, those near each other in one', () => {
  expect(runsOf(Uint32Array.of(900, 12, 10, 40, 905), 1000)).toEqual([{ first: 10, last: 40 }, { first: 900, last: 905 }]);
});

test('a jump in a long row sends the part between and little more', () => {
  const moved = Uint32Array.from({ length: 100_000 }, (_, i) => 300_000 + ((i * 7919) % 100_000)); // in no order
  const { missed, sent } = covered(runsOf(moved, 1_000_000), moved.subarray(0, 2000));
  expect(missed).toBe(0);
  expect(sent).toBeLessThan(101_100); // a block of 512 more at either end
});

test('the last brick of the last block is the last brick there is', () => {
  const moved = Uint32Array.from({ length: 5000 }, (_, i) => 10_000 - 1 - 2 * i);
  expect(runsOf(moved, 10_000)).toEqual([{ first: 0, last: 9999 }]);
});
