/**
 * What the page's own thread does from frame to frame, all of it: scripts, layout, painting, garbage, by the browser's tracing.
 * A frame is what lies between two calls of requestAnimationFrame, which `kTicker` asks for without end.
 */

import type { Browser } from 'playwright-core';

interface TraceEvent {
  name: string;
  ph: string;
  pid: number;
  tid: number;
  /** [us] */
  ts: number;
  dur?: number;
  tdur?: number;
  args?: { name?: string };
}

export interface Busy {
  /** Busy time of each frame [ms of the wall's clock], ascending. */
  frames: number[];
  /** Tasks over 8 ms in the order of their times [ms]. */
  long: number[];
}

/** To run in the page before anything else: frames that can be counted, whether the page draws or not. */
export const kTicker = `(() => { const tick = () => requestAnimationFrame(tick); tick(); })();`;

/** Begins to watch. @returns How to end it. */
export async function watchMainThread(browser: Browser): Promise<() => Promise<Busy>> {
  const session = await browser.newBrowserCDPSession();
  const events: TraceEvent[] = [];
  session.on('Tracing.dataCollected', ({ value }) => events.push(...(value as unknown as TraceEvent[])));
  await session.send('Tracing.start', {
    transferMode: 'ReportEvents',
    traceConfig: { includedCategories: ['toplevel', 'devtools.timeline', 'disabled-by-default-devtools.timeline', '__metadata'] },
  });
  return async () => {
    const over = new Promise((done) => session.once('Tracing.tracingComplete', done));
    await session.send('Tracing.end');
    await over;
    await session.detach();
    return busyOf(events);
  };
}

/** The thread that answers requestAnimationFrame, its tasks cut at those answers. */
function busyOf(events: readonly TraceEvent[]): Busy {
  const ticks = events.filter((one) => one.name === 'FireAnimationFrame').sort((a, b) => a.ts - b.ts);
  const counts = new Map<string, number>();
  const threadOf = (one: TraceEvent): string => `${one.pid} ${one.tid}`;
  for (const tick of ticks) counts.set(threadOf(tick), (counts.get(threadOf(tick)) ?? 0) + 1);
  const thread = [...counts].sort((a, b) => b[1] - a[1])[0]?.[0];
  const times = ticks.filter((one) => threadOf(one) === thread).map((one) => one.ts);
  const frames = new Array<number>(Math.max(0, times.length - 1)).fill(0);
  const long: number[] = [];
  const tasks = events.filter((one) => one.name === 'RunTask' && one.ph === 'X' && threadOf(one) === thread).sort((a, b) => a.ts - b.ts);
  for (const task of tasks) {
    const took = (task.dur ?? 0) / 1000;
    if (took > 8) long.push(Math.round(took));
    const next = times.findIndex((time) => time > task.ts);
    if (next > 0) frames[next - 1] += took;
  }
  return { frames: frames.sort((a, b) => a - b), long };
}
