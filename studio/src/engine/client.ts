/** The page's side of the engine's worker: orders as promises. Of many orders to read a layout only the last one is answered. */

import type { Loaded } from '../recording/load.ts';
import type { Recording } from '../recording/types.ts';
import type { Draft, Picture, PictureOrder } from './engine.ts';
import type { EngineOrder, EngineReport, Source } from './worker.ts';

export type { Source } from './worker.ts';

/** A layout as it is drawn: its bricks, and what is said of them. */
export interface ReadLayout extends Omit<Draft, 'scene'> {
  recording: Recording;
}

/** The engine refuses a layout: every problem, a sentence each. */
export class Refused extends Error {
  override name = 'Refused';
  constructor(readonly problems: string[]) {
    super(problems.join('\n'));
  }
}

/** A newer order took its place, or it was taken back before anything was done. */
export class Superseded extends Error {
  override name = 'Superseded';
}

export interface RunWatch {
  grown(loaded: Loaded): void;
  progress(time: number, arrived: number): void;
}

export interface Finished {
  loaded: Loaded;
  hash: string;
  /** The whole recording, a `.topple` file. */
  bytes: Uint8Array<ArrayBuffer>;
  /** Computing alone [s]. */
  cost: number;
}

interface Waiting {
  resolve: (value: never) => void;
  reject: (error: Error) => void;
  watch?: RunWatch;
}

export class EngineClient {
  private readonly worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });
  private readonly waiting = new Map<number, Waiting>();
  private next = 1;
  private reading = 0;
  private held: { source: Source; waiting: Waiting } | null = null;
  /** Rejects where the engine is not there. */
  readonly ready: Promise<void>;

  constructor() {
    this.ready = new Promise((resolve, reject) => {
      this.worker.addEventListener('message', (message: MessageEvent<EngineReport>) => {
        if (message.data.kind === 'ready') resolve();
        else if (message.data.kind === 'absent') reject(new Error(message.data.message));
        else this.take(message.data);
      });
      this.worker.addEventListener('error', () => reject(new Error('The engine’s part of the page did not start. Reload the page.')));
    });
    this.ready.catch(() => undefined);
    this.send({ kind: 'load', url: new URL('engine.wasm', document.baseURI).href });
  }

  private send(order: EngineOrder): void {
    this.worker.postMessage(order);
  }

  private take(report: Exclude<EngineReport, { kind: 'ready' | 'absent' }>): void {
    const waiting = this.waiting.get(report.id);
    if (report.kind === 'grown') return waiting?.watch?.grown(report.loaded);
    if (report.kind === 'progress') return waiting?.watch?.progress(report.time, report.arrived);
    this.waiting.delete(report.id);
    if (report.id === this.reading) this.readNext();
    if (!waiting) return;
    if (report.kind === 'draft') waiting.resolve({ ...report.draft, recording: report.recording } as never);
    else if (report.kind === 'picture') waiting.resolve(report.picture as never);
    else if (report.kind === 'over') waiting.resolve(report as never);
    else if (report.kind === 'unbegun') waiting.reject(new Superseded());
    else if (report.kind === 'problems') waiting.reject(new Refused(report.problems));
    else waiting.reject(new Error(report.message));
  }

  /** Reads a layout. While one is read the newest order waits; an older one that waited is dropped. */
  read(source: Source): Promise<ReadLayout> {
    return new Promise<ReadLayout>((resolve, reject) => {
      this.held?.waiting.reject(new Superseded());
      this.held = { source, waiting: { resolve: resolve as (value: never) => void, reject } };
      if (!this.reading) this.readNext();
    });
  }

  private readNext(): void {
    this.reading = 0;
    if (!this.held) return;
    const { source, waiting } = this.held;
    this.held = null;
    this.reading = this.next++;
    this.waiting.set(this.reading, waiting);
    this.send({ kind: 'read', id: this.reading, source });
  }

  /**
   * @param native An address of the program that serves the page, which then runs the layout in this engine's place.
   * @returns The run's end, and how to stop it: then it ends where it is.
   */
  run(source: Source, watch?: RunWatch, native = ''): { finished: Promise<Finished>; stop: () => void } {
    const id = this.next++;
    const finished = new Promise<Finished>((resolve, reject) => {
      this.waiting.set(id, { resolve: resolve as (value: never) => void, reject, ...(watch ? { watch } : {}) });
      this.send({ kind: 'run', id, source, ...(native ? { native: new URL(native, document.baseURI).href } : {}) });
    });
    return { finished, stop: () => this.send({ kind: 'stop', id }) };
  }

  /** An image as bricks. Rejects with Refused where they are too few or too many. */
  picture(order: PictureOrder): Promise<Picture> {
    const id = this.next++;
    return new Promise<Picture>((resolve, reject) => {
      this.waiting.set(id, { resolve: resolve as (value: never) => void, reject });
      this.send({ kind: 'picture', id, order });
    });
  }

  close(): void {
    this.worker.terminate();
  }
}
