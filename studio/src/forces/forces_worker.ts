/**
 * Runs a layout a second time for the forces at its contacts, which a recording does not hold: up to a little beyond the time that is
 * looked at, in short stretches, so that it hears of another one. The same engine and so the same bits as the run that is shown.
 */

import { Engine } from '../engine/engine.ts';
import type { Source } from '../engine/worker.ts';

export type ForcesOrder = { kind: 'begin'; id: number; source: Source; url: string } | { kind: 'reach'; time: number };
export type ForcesReport =
  | { kind: 'steps'; id: number; bytes: Uint8Array<ArrayBuffer>; over: boolean }
  | { kind: 'failed'; id: number; message: string };

/** How far ahead of the wanted time it goes [s of the run]. */
const kAhead = 1;
/** How long a stretch may take [ms], and how large what it tells may become [bytes]. */
const kStretch = 25;
const kMostBytes = 1 << 20;

let engine: Promise<Engine> | null = null;
let current = -1;
let wanted = 0;
let reached = 0;
let over = true;
let busy = false;

const tell = (report: ForcesReport, transfer: Transferable[] = []): void => self.postMessage(report, { transfer });

self.onmessage = async (message: MessageEvent<ForcesOrder>) => {
  const order = message.data;
  if (order.kind === 'reach') {
    wanted = order.time;
    if (!busy) void goOn();
    return;
  }
  const { id, source, url } = order;
  current = id;
  over = true;
  try {
    engine ??= fetch(url).then(async (answer) => {
      if (!answer.ok) throw new Error(`the server answers ${answer.status}`);
      return Engine.load(await answer.arrayBuffer());
    });
    const c = await engine;
    if (current !== id) return;
    c.watch(source.text, source.name, source.overrides);
    [reached, over] = [0, false];
    if (!busy) void goOn();
  } catch (error) {
    tell({ kind: 'failed', id, message: error instanceof Error ? error.message : String(error) });
  }
};

async function goOn(): Promise<void> {
  busy = true;
  const c = await (engine as Promise<Engine>);
  let steps = 4;
  while (!over && reached < wanted + kAhead) {
    const id = current;
    const from = performance.now();
    const { bytes, more } = c.watchSteps(steps);
    const took = performance.now() - from;
    over = !more;
    reached = lastTime(bytes) ?? reached;
    const growth = Math.min(kStretch / Math.max(took, 0.5), kMostBytes / Math.max(bytes.length, 1), 4);
    steps = Math.max(1, Math.floor(steps * growth));
    tell({ kind: 'steps', id, bytes, over }, [bytes.buffer]);
    await new Promise((resume) => setTimeout(resume, 0)); // orders come in
  }
  busy = false;
}

/** Of the last step in there [s]. */
function lastTime(bytes: Uint8Array<ArrayBuffer>): number | null {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  let time: number | null = null;
  for (let at = 0; at + 16 <= bytes.length; at += 16 + 32 * view.getUint32(at + 8, true)) time = view.getFloat64(at, true);
  return time;
}
