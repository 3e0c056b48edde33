/** Starts the worker that fetches and decodes a recording; the page's side of worker.ts. */

import type { Front } from './wave.ts';
import type { Recording } from './types.ts';
import type { Order, Report } from './worker.ts';

export interface Loaded {
  recording: Recording;
  front: Front;
  /** When each fallen brick passed its tip angle, in order [s]. */
  falls: Float64Array;
}

export interface LoadProgress {
  words: string;
  /** 0 to 1; NaN while not known. */
  part: number;
}

/** @returns How to cancel it. */
export function load(
  order: Order,
  on: { progress: (p: LoadProgress) => void; done: (loaded: Loaded) => void; failed: (message: string) => void },
): () => void {
  const worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });
  worker.onmessage = (message: MessageEvent<Report>) => {
    const report = message.data;
    if (report.kind === 'loading' || report.kind === 'decoding') return on.progress(progressOf(report));
    worker.terminate();
    if (report.kind === 'done') on.done(report);
    else on.failed(report.message);
  };
  worker.onerror = () => {
    worker.terminate();
    on.failed('The part of the page that reads recordings did not start. Reload the page.');
  };
  worker.postMessage(order, 'bytes' in order ? [order.bytes] : []);
  return () => worker.terminate();
}

function progressOf(report: Extract<Report, { kind: 'loading' | 'decoding' }>): LoadProgress {
  const number = (value: number): string => value.toLocaleString('en-GB');
  if (report.kind === 'decoding') {
    const done = Math.min(report.done, report.bricks);
    return { words: `${number(done)} of ${number(report.bricks)} bricks`, part: report.bricks ? done / report.bricks : NaN };
  }
  const mega = (bytes: number): string => (bytes / 1e6).toFixed(1);
  if (!report.of) return { words: `${mega(report.bytes)} MB`, part: NaN };
  return { words: `${mega(report.bytes)} of ${mega(report.of)} MB`, part: report.bytes / report.of };
}
