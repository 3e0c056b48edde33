/**
 * One of the workers that share the runs of a study: bricks put down anew by hand in each run (docs/risk.md). Each runs
 * the seeds that it is given; the first one is also given all runs, and says what they came to.
 */

import { Engine, type Risk } from '../engine/engine.ts';
import type { Source } from '../engine/worker.ts';

export type RiskOrder =
  /** Errors are standard deviations [m, rad]. */
  | { kind: 'begin'; source: Source; position: number; heading: number; url: string }
  | { kind: 'run'; seed: number }
  | { kind: 'add'; run: Float64Array<ArrayBuffer> }
  | { kind: 'say' };

export type RiskReport =
  /** The run with every brick exactly in its place is done. */
  | { kind: 'begun' }
  | { kind: 'ran'; run: Float64Array<ArrayBuffer> }
  | { kind: 'risk'; risk: Risk }
  | { kind: 'failed'; message: string };

let engine: Promise<Engine> | null = null;

const tell = (report: RiskReport, transfer: Transferable[] = []): void => self.postMessage(report, { transfer });

self.onmessage = async (message: MessageEvent<RiskOrder>) => {
  try {
    await take(message.data);
  } catch (error) {
    tell({ kind: 'failed', message: error instanceof Error ? error.message : String(error) });
  }
};

async function load(url: string): Promise<Engine> {
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`the server answers ${answer.status}`);
  return Engine.load(await answer.arrayBuffer());
}

async function take(order: RiskOrder): Promise<void> {
  if (order.kind === 'begin') {
    engine = load(order.url);
    const { text, name, overrides } = order.source;
    (await engine).riskBegin(text, name, overrides, order.position, order.heading);
    tell({ kind: 'begun' });
  } else if (engine) {
    const c = await engine;
    if (order.kind === 'add') c.riskAdd(order.run);
    else if (order.kind === 'say') tell({ kind: 'risk', risk: c.risk() });
    else {
      const run = c.riskRun(order.seed);
      tell({ kind: 'ran', run }, [run.buffer]);
    }
  }
}
