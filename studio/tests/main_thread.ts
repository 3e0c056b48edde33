/**
 * What the page's own thread does from frame to frame, all of it: scripts, layout, painting, garbage, by the browser's tracing.
 * A frame is what lies between two calls of requestAnimationFrame and the answer to the second, in which the page draws. While the page
 * opens, `kTicker` asks for them without end; later the page itself does, and only frames count in which it drew.
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
  /** Of it, in which the thread had a processor [us]. */
  tdur?: number;
}

export interface Frame {
  /** How long the thread was at it [ms of the wall's clock], and for how long of that it had a processor: the rest it waited. */
  busy: number;
  cpu: number;
  drew: boolean;
}

export interface Watched {
  frames: Frame[];
  /** Tasks over 8 ms in the order of their times [ms]. */
  long: number[];
}

/** To run in the page before anything else: frames that can be counted, whether the page draws or not, until `untick` is set. */
export const kTicker = `(() => { const tick = () => window.untick || requestAnimationFrame(tick); tick(); })();`;

/**
 * To run in the page before anything else: what it draws with instances and uploads is counted, and marked for the tracing.
 * @param few Whether of all those instances but one is drawn: the page makes the same calls with the same buffers, what draws has little to do.
 */
export const counter = (few: boolean): string => `(() => {
  const counts = (window.glCounts = { draws: 0, bytes: 0 });
  const of = WebGL2RenderingContext.prototype;
  const [draw, upload, make] = [of.drawElementsInstanced, of.bufferSubData, of.bufferData];
  of.drawElementsInstanced = function (mode, count, type, offset, instances) {
    counts.draws++;
    performance.mark('drawn');
    return draw.call(this, mode, count, type, offset, ${few ? 'Math.min(1, instances)' : 'instances'});
  };
  of.bufferSubData = function (...words) {
    counts.bytes += words[4] ? words[4] * words[2].BYTES_PER_ELEMENT : words[2].byteLength;
    return upload.apply(this, words);
  };
  of.bufferData = function (...words) {
    counts.bytes += words[1].byteLength ?? words[1];
    return make.apply(this, words);
  };
})();`;

/** Begins to watch. @returns How to end it. */
export async function watchMainThread(browser: Browser): Promise<() => Promise<Watched>> {
  const session = await browser.newBrowserCDPSession();
  const events: TraceEvent[] = [];
  session.on('Tracing.dataCollected', ({ value }) => events.push(...(value as unknown as TraceEvent[])));
  await session.send('Tracing.start', {
    transferMode: 'ReportEvents',
    traceConfig: { includedCategories: ['devtools.timeline', 'disabled-by-default-devtools.timeline', 'blink.user_timing', '__metadata'] },
  });
  return async () => {
    const over = new Promise((done) => session.once('Tracing.tracingComplete', done));
    await session.send('Tracing.end');
    await over;
    await session.detach();
    return framesOf(events);
  };
}

/** The thread that answers requestAnimationFrame, its tasks cut at those answers; the task of an answer ends the frame. */
function framesOf(events: readonly TraceEvent[]): Watched {
  const ticks = events.filter((one) => one.name === 'FireAnimationFrame').sort((a, b) => a.ts - b.ts);
  const counts = new Map<string, number>();
  const threadOf = (one: TraceEvent): string => `${one.pid} ${one.tid}`;
  for (const tick of ticks) counts.set(threadOf(tick), (counts.get(threadOf(tick)) ?? 0) + 1);
  const thread = [...counts].sort((a, b) => b[1] - a[1])[0]?.[0];
  const here = events.filter((one) => threadOf(one) === thread);
  const times = ticks.filter((one) => threadOf(one) === thread).map((one) => one.ts);
  const marks = here.filter((one) => one.name === 'drawn').map((one) => one.ts);
  const frames = times.slice(1).map((): Frame => ({ busy: 0, cpu: 0, drew: false }));
  const long: number[] = [];
  const tasks = here.filter((one) => one.name === 'RunTask' && one.ph === 'X').sort((a, b) => a.ts - b.ts);
  for (const task of tasks) {
    const took = task.dur ?? 0;
    if (took > 8000) long.push(Math.round(took / 1000));
    const frame = frames[times.findIndex((time) => time > task.ts) - 1];
    if (!frame) continue;
    frame.busy += took / 1000;
    frame.cpu += (task.tdur ?? took) / 1000;
    frame.drew ||= marks.some((mark) => mark >= task.ts && mark <= task.ts + took);
  }
  return { frames, long };
}
