/** How likely the run that is shown stops if its bricks are put down by hand, and where: asked of engines beside the one that ran it. */

import type { Risk } from '../engine/engine.ts';
import type { Recording } from '../recording/types.ts';
import type { RiskOrder, RiskReport } from './risk_worker.ts';

/** Workers, each with an engine of its own; one processor stays for the page. */
const kWorkers = Math.max(1, Math.min(8, (navigator.hardwareConcurrency || 2) - 1));
/** How often what all runs came to is asked for while they go on [ms]. */
const kSayEvery = 300;

/** How a hand puts bricks down: standard deviations. */
export interface HandErrors {
  /** Along x, and along y [mm]. */
  position: number;
  /** [degrees] */
  heading: number;
}

export class RiskStudy {
  /** As they are asked for next. */
  errors = $state<HandErrors>({ position: 0.5, heading: 1.7 });
  /** Runs that are asked for at a time. */
  more = $state(100);
  /** `exact`: every brick exactly in its place; `stopping`: runs under way come to their ends. */
  doing = $state<'' | 'exact' | 'runs' | 'stopping'>('');
  /** Runs that are done, and are to be. */
  done = $state(0);
  wanted = $state(0);
  /** What they came to, and of which errors that is true. */
  risk = $state.raw<Risk | null>(null);
  asked = $state.raw<HandErrors | null>(null);
  /** Why nothing can be said; empty: it can. */
  problem = $state('');
  private workers: Worker[] = [];
  private idle: Worker[] = [];
  private recipe: Recording['recipe'] | null = null;
  /** Seeds are given out in their order, so that what is done is always the first so many of them. */
  private given = 0;
  private saying = false;
  private said = 0;

  /** Says which run is shown: what was found of another one is forgotten. */
  follow(recording: Recording | null): void {
    const recipe = recording?.recipe ?? null;
    if (!isSame(recipe, this.recipe)) this.forget();
    this.recipe = recipe;
  }

  /** Asks for so many runs more; of other errors than before everything begins anew. */
  ask(recording: Recording): void {
    if (this.doing) return;
    const { layoutText, layoutName, overrides } = recording.recipe;
    const { position, heading } = this.errors;
    if (this.workers.length > 0 && this.asked?.position === position && this.asked.heading === heading) return this.goOn();
    this.forget();
    if (!layoutText) return this.fail('This recording does not hold its layout, so its bricks cannot be put down anew.');
    this.asked = { position, heading };
    this.doing = 'exact';
    // Bricks that a hand has put down are in no plane: the other models are no judges of them.
    const source = { text: layoutText, name: layoutName, overrides: [...overrides, 'model.name=rigid'] };
    const order: RiskOrder = { kind: 'begin', source, position: position / 1000, heading: (heading / 180) * Math.PI, url: new URL('engine.wasm', document.baseURI).href };
    for (let i = 0; i < kWorkers; i++) this.workers.push(this.employ(order));
  }

  /** Runs under way are finished and count. */
  stop(): void {
    if (this.doing === 'exact') this.forget();
    else if (this.doing === 'runs') [this.doing, this.wanted] = ['stopping', this.given];
  }

  /** Ends all work and lets go what is known. */
  forget(): void {
    for (const worker of this.workers) worker.terminate();
    [this.workers, this.idle] = [[], []];
    [this.risk, this.asked] = [null, null];
    [this.doing, this.problem] = ['', ''];
    [this.done, this.wanted, this.given, this.saying] = [0, 0, 0, false];
  }

  private employ(order: RiskOrder): Worker {
    const worker = new Worker(new URL('./risk_worker.ts', import.meta.url), { type: 'module' });
    worker.onmessage = (message: MessageEvent<RiskReport>) => this.take(worker, message.data);
    worker.onerror = () => this.fail('The part of the page that puts bricks down anew did not start. Reload the page.');
    send(worker, order);
    return worker;
  }

  private take(worker: Worker, report: RiskReport): void {
    if (report.kind === 'failed') this.fail(report.message.replace(/^layout\.toml(:\d+)*: /, ''));
    else if (report.kind === 'risk') this.hear(report.risk);
    else if (report.kind === 'ran') {
      this.done++;
      send(this.workers[0], { kind: 'add', run: report.run }, [report.run.buffer]);
      this.employAgain(worker);
      if (this.done === this.wanted || performance.now() - this.said > kSayEvery) this.say();
    } else {
      // All begin with the same: it is done when the slowest has done it.
      this.idle.push(worker);
      if (this.idle.length === this.workers.length) this.goOn();
    }
  }

  private goOn(): void {
    this.doing = 'runs';
    this.wanted = this.done + this.more;
    for (const worker of this.idle.splice(0)) this.employAgain(worker);
  }

  private employAgain(worker: Worker): void {
    if (this.given < this.wanted) send(worker, { kind: 'run', seed: ++this.given });
    else this.idle.push(worker);
  }

  private say(): void {
    if (this.saying && this.done < this.wanted) return;
    this.saying = true;
    this.said = performance.now();
    send(this.workers[0], { kind: 'say' });
  }

  private hear(risk: Risk): void {
    this.saying = false;
    this.risk = risk;
    if (risk.runs + risk.notBuilt === this.wanted) this.doing = '';
  }

  private fail(why: string): void {
    this.forget();
    this.problem = why;
  }
}

const send = (worker: Worker, order: RiskOrder, transfer: Transferable[] = []): void => worker.postMessage(order, transfer);

/** Whether two runs are of one layout with the same settings: one that grows comes again and again. */
function isSame(one: Recording['recipe'] | null, other: Recording['recipe'] | null): boolean {
  return one?.layoutText === other?.layoutText && one?.overrides.join('\n') === other?.overrides.join('\n');
}
