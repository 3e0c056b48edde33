/** Which part of a page's scripts are calls of WebGL, and which calls, by the sampling profiler. */

import type { CDPSession, Page } from 'playwright-core';

export interface Split {
  /** The page's own functions, and their calls of WebGL [ms]. */
  own: number;
  calls: number;
  /** Calls of WebGL by what they took [ms], the dearest first. */
  dearest: [string, number][];
}

/** Begins to sample. @returns How to end it. */
export async function splitScripts(page: Page, session: CDPSession): Promise<() => Promise<Split>> {
  const calls = new Set(await page.evaluate(() => Object.getOwnPropertyNames(WebGL2RenderingContext.prototype)));
  await session.send('Profiler.enable');
  await session.send('Profiler.setSamplingInterval', { interval: 100 });
  await session.send('Profiler.start');
  return async () => {
    const { profile } = await session.send('Profiler.stop');
    const frames = new Map(profile.nodes.map(({ id, callFrame }) => [id, callFrame]));
    const split: Split = { own: 0, calls: 0, dearest: [] };
    const each = new Map<string, number>();
    (profile.samples ?? []).forEach((id, i) => {
      const { functionName, url } = frames.get(id)!;
      const took = Math.max(0, profile.timeDeltas?.[i] ?? 0) / 1000;
      if (url.startsWith('http')) split.own += took; // what has no address is the browser's, or the test's
      else if (calls.has(functionName)) {
        split.calls += took;
        each.set(functionName, (each.get(functionName) ?? 0) + took);
      }
    });
    split.dearest = [...each].sort((a, b) => b[1] - a[1]).slice(0, 3);
    return split;
  };
}
