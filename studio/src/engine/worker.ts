/** Runs the engine off the page's thread. It takes one order at a time; a run is done in short stretches, so that it hears when to stop. */

import { buffersOf } from '../recording/buffers.ts';
import { decodeRecording } from '../recording/decode.ts';
import { GrowingRecording } from '../recording/growing.ts';
import type { Loaded } from '../recording/load.ts';
import type { Recording } from '../recording/types.ts';
import { findFalls, findFront } from '../recording/wave.ts';
import { Engine, LayoutError, type Draft, type Picture, type PictureOrder } from './engine.ts';

/** A layout as text, and what the command line's `--set` would say. */
export interface Source {
  text: string;
  name: string;
  overrides: readonly string[];
}

export type EngineOrder =
  | { kind: 'load'; url: string }
  | { kind: 'read'; id: number; source: Source }
  /** `native`: an address of the program that serves the page; it runs the layout in this engine's place. */
  | { kind: 'run'; id: number; source: Source; native?: string }
  | { kind: 'picture'; id: number; order: PictureOrder }
  | { kind: 'stop'; id: number };

export type EngineReport =
  | { kind: 'ready' }
  | { kind: 'absent'; message: string }
  | { kind: 'draft'; id: number; draft: Omit<Draft, 'scene'>; recording: Recording }
  | { kind: 'picture'; id: number; picture: Picture }
  | { kind: 'problems'; id: number; problems: string[] }
  | { kind: 'broken'; id: number; message: string }
  /** A run was stopped before it began. */
  | { kind: 'unbegun'; id: number }
  | { kind: 'progress'; id: number; time: number; arrived: number }
  | { kind: 'grown'; id: number; loaded: Loaded; over: false }
  | { kind: 'over'; id: number; loaded: Loaded; hash: string; bytes: Uint8Array<ArrayBuffer>; cost: number };

/** How long a stretch may take [ms]: a stop is heard after so long. */
const kStretch = 25;
/** How often what was recorded is shown [ms]. */
const kLookEvery = 250;

let engine: Engine | null = null;
/** Orders wait for it. */
let loading: Promise<void> = Promise.resolve();
/** Runs that are ordered and not over, and how each is stopped, whether it has begun or not. */
const going = new Map<number, AbortController>();
/** Runs come one after the other. */
let queue: Promise<void> = Promise.resolve();

const tell = (report: EngineReport, transfer: Transferable[] = []): void => self.postMessage(report, { transfer });

self.onmessage = (message: MessageEvent<EngineOrder>) => {
  const order = message.data;
  if (order.kind === 'load') loading = load(order.url);
  else if (order.kind === 'stop') going.get(order.id)?.abort();
  else if (order.kind === 'read') void attempt(order.id, () => read(order.id, order.source));
  else if (order.kind === 'picture') void attempt(order.id, () => tell({ kind: 'picture', id: order.id, picture: (engine as Engine).picture(order.order) }));
  else {
    for (const before of going.values()) before.abort();
    const { id, source, native } = order;
    const stop = new AbortController();
    going.set(id, stop);
    queue = queue.then(() => attempt(id, () => (native ? runNative(id, source, native, stop.signal) : run(id, source, stop.signal)))).then(() => void going.delete(id));
  }
};

async function load(url: string): Promise<void> {
  try {
    const answer = await fetch(url);
    if (!answer.ok || !(answer.headers.get('content-type') ?? 'application/wasm').includes('wasm')) {
      // A server that does not know the type may still have the file.
      const bytes = answer.ok ? await answer.arrayBuffer() : new ArrayBuffer(0);
      if (bytes.byteLength < 8) throw new Error(`the server answers ${answer.status}`);
      engine = await Engine.load(bytes);
    } else engine = await Engine.load(answer);
    tell({ kind: 'ready' });
  } catch (error) {
    tell({ kind: 'absent', message: `The engine is not in this page (${String(error)}). Recordings can be played; layouts cannot be run here.` });
  }
}

async function attempt(id: number, work: () => void | Promise<void>): Promise<void> {
  await loading;
  try {
    await work();
  } catch (error) {
    if (error instanceof LayoutError) tell({ kind: 'problems', id, problems: error.problems });
    else tell({ kind: 'broken', id, message: `The engine stopped: ${String(error)}. The layout is untouched.` });
  }
}

function read(id: number, source: Source): void {
  const { scene, ...draft } = (engine as Engine).read(source.text, source.name, source.overrides);
  const recording = decodeRecording(scene);
  tell({ kind: 'draft', id, draft, recording }, buffersOf(recording));
}

/** Lets waiting messages in. */
const breathe = (): Promise<void> =>
  new Promise((resume) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      port1.close();
      resume();
    };
    port2.postMessage(0);
  });

async function run(id: number, source: Source, stop: AbortSignal): Promise<void> {
  const began = performance.now();
  let computed = 0;
  const c = engine as Engine;
  const growing = new GrowingRecording();
  growing.add(c.start(source.text, source.name, source.overrides));
  let steps = 1;
  let looked = began;
  for (;;) {
    const from = performance.now();
    const more = c.advance(steps);
    const took = performance.now() - from;
    computed += took;
    steps = Math.max(1, Math.min(65536, took < 1 ? steps * 2 : Math.floor((steps * kStretch) / took)));
    if (!more) break;
    if (stop.aborted) {
      c.stop();
      break;
    }
    if (performance.now() - looked > kLookEvery) {
      looked = performance.now();
      growing.add(c.collect(false));
      lookAt(id, growing);
      tell({ kind: 'progress', id, time: c.time, arrived: c.arrived });
    }
    await breathe();
  }
  growing.add(c.collect(true));
  const bytes = growing.bytes();
  const hash = c.hash;
  tellLoaded(growing.look(true), (loaded) => ({ kind: 'over', id, loaded, hash, bytes, cost: computed / 1000 }));
}

function lookAt(id: number, growing: GrowingRecording): void {
  if (!growing.worthALook) return;
  const recording = growing.glance(false);
  if (recording && recording.duration > 0) tellLoaded(recording, (loaded) => ({ kind: 'grown', id, loaded, over: false }));
}

/** The same recording, from the program that serves the page: it comes in pieces as the run goes on. A stop ends both. */
async function runNative(id: number, source: Source, address: string, stop: AbortSignal): Promise<void> {
  const began = performance.now();
  /** Null where a stop comes in between. */
  const unlessStopped = <T>(work: Promise<T>): Promise<T | null> =>
    work.catch((error: Error) => {
      if (stop.aborted) return null;
      throw error;
    });
  const answer = await unlessStopped(fetch(address, { method: 'POST', body: source.text, headers: { 'content-type': 'text/plain' }, signal: stop }));
  if (!answer) return tell({ kind: 'unbegun', id });
  if (answer.status === 422) throw new LayoutError(await answer.text());
  if (!answer.ok || !answer.body) throw new Error(`the program answers ${answer.status}: ${await answer.text()}`);
  const reader = (answer.body as ReadableStream<Uint8Array<ArrayBuffer>>).getReader();
  const growing = new GrowingRecording();
  let looked = began;
  for (;;) {
    const piece = await unlessStopped(reader.read());
    if (!piece || piece.done) break;
    growing.add(piece.value);
    if (performance.now() - looked < kLookEvery) continue;
    looked = performance.now();
    lookAt(id, growing);
    tell({ kind: 'progress', id, time: growing.reached, arrived: 0 });
  }
  const recording = stop.aborted ? growing.glance(true) : growing.look(true);
  if (!recording) return tell({ kind: 'unbegun', id });
  const { hash } = recording.end;
  const bytes = growing.bytes();
  tellLoaded(recording, (loaded) => ({ kind: 'over', id, loaded, hash, bytes, cost: (performance.now() - began) / 1000 }));
}

function tellLoaded(recording: Recording, report: (loaded: Loaded) => EngineReport): void {
  const loaded = { recording, front: findFront(recording), falls: findFalls(recording) };
  tell(report(loaded), buffersOf(loaded));
}
