/** The forces at contacts of the run that is shown, kept around the time that is looked at; nothing is computed until they are wanted. */

import type { Recording } from '../recording/types.ts';
import { ContactSteps, type ContactForce } from './contact_steps.ts';
import type { ForcesOrder, ForcesReport } from './forces_worker.ts';

/** What may be kept [bytes]: some seconds of a field of 10,000 bricks, all of a row of 5,000. */
const kMostKept = 96e6;

export interface ForcesAt {
  /** Of the step whose forces these are [s]. */
  time: number;
  contacts: ContactForce[];
}

export class Forces {
  on = $state(false);
  /** Why there are none; empty: there are, or will be. */
  problem = $state('');
  /** Counts what has come. */
  version = $state(0);
  private worker: Worker | null = null;
  private id = 0;
  private run = '';
  private recording: Recording | null = null;
  private kept: ContactSteps[] = [];
  private size = 0;
  private over = false;

  toggle(): void {
    this.on = !this.on;
    if (!this.on) this.close();
  }

  /** Says what is looked at: a time of a run [s]. */
  want(recording: Recording, time: number): void {
    this.follow(recording);
    const first = this.kept[0];
    if (first && time < first.first - 1e-9 && first.first > this.beginning) this.begin(); // it was let go
    this.worker?.postMessage({ kind: 'reach', time } satisfies ForcesOrder);
  }

  /** The forces at a time [s]; null: they are being computed, or there are none. */
  at(time: number): ForcesAt | null {
    if (this.problem) return null;
    const index = this.kept.findIndex((one) => time < one.last + 1e-9);
    const steps = index >= 0 ? this.kept[index] : this.over ? this.kept.at(-1) : undefined;
    if (!steps) return null;
    const after = steps.times.findIndex((one) => one > time + 1e-9);
    const step = after < 0 ? steps.times.length - 1 : after - 1;
    if (step >= 0) return { time: steps.times[step], contacts: steps.at(step) };
    const before = this.kept[index - 1]; // the last step of the stretch before
    if (before) return { time: before.last, contacts: before.at(before.times.length - 1) };
    return steps.first <= this.beginning ? { time: 0, contacts: [] } : null;
  }

  /** Time of the very first step [s]. */
  private beginning = Infinity;

  private follow(recording: Recording): void {
    if (recording === this.recording) return;
    this.recording = recording;
    const { layoutText, model, overrides } = recording.recipe;
    const run = JSON.stringify([layoutText, model, overrides]); // a run that grows stays the same
    if (run === this.run) return;
    this.run = run;
    this.begin();
  }

  private begin(): void {
    this.close();
    const recipe = this.recording?.recipe;
    if (!recipe) return;
    if (!recipe.layoutText) this.problem = 'This recording does not hold its layout, which the forces need.';
    else if (recipe.model === 'pivot') this.problem = 'Pivot hands hits on and knows no forces between bricks that lean; hinge and rigid do.';
    if (this.problem) return;
    const worker = new Worker(new URL('./forces_worker.ts', import.meta.url), { type: 'module' });
    this.worker = worker;
    const id = ++this.id;
    worker.onmessage = (message: MessageEvent<ForcesReport>) => {
      if (message.data.id === this.id) this.take(message.data);
    };
    worker.onerror = () => (this.problem = 'The part of the page that computes forces did not start. Reload the page.');
    const source = { text: recipe.layoutText, name: recipe.layoutName, overrides: [...recipe.overrides, `model.name=${recipe.model}`] };
    worker.postMessage({ kind: 'begin', id, source, url: new URL('engine.wasm', document.baseURI).href } satisfies ForcesOrder);
  }

  private take(report: ForcesReport): void {
    if (report.kind === 'failed') {
      this.problem = `The forces cannot be computed here: ${report.message}.`;
      return;
    }
    const steps = new ContactSteps(report.bytes);
    this.over = report.over;
    this.beginning = Math.min(this.beginning, steps.first);
    this.kept.push(steps);
    this.size += steps.bytes.length;
    while (this.size > kMostKept && this.kept.length > 1) this.size -= (this.kept.shift() as ContactSteps).bytes.length;
    this.version++;
  }

  /** Forgets all; what is wanted again is computed again. */
  close(): void {
    this.worker?.terminate();
    this.worker = null;
    this.id++;
    this.kept = [];
    this.size = 0;
    this.over = false;
    this.beginning = Infinity;
    this.problem = '';
    if (!this.on) [this.run, this.recording] = ['', null];
  }
}
