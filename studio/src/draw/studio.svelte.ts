/**
 * The layout being drawn: its text, which is the document, what the engine says of it, what is chosen, and every earlier state of it.
 * Where bricks stand is never worked out here: the text goes to the engine, and its answer is what is shown.
 */

import { EngineClient, Refused, Superseded, type Finished, type ReadLayout, type RunWatch } from '../engine/client.ts';
import type { Part } from '../recording/types.ts';
import { lastArrival } from '../recording/wave.ts';
import { knows, mirrorPart, movePart, nameOf, partsOf, pointsOf, turnPart, type Point } from './parts.ts';
import type { Style } from './shapes.ts';
import { Block, TomlFile } from './toml.ts';

export type Tool = 'select' | 'row' | 'curve' | 'circle' | 'spiral' | 'ess' | 'split' | 'brick' | 'field' | 'wall' | 'tower' | 'pyramid' | 'ball' | 'push' | 'measure' | 'brush' | 'picture';

/** Bricks of a part: ends of what it made [first, last]. */
export interface Span {
  first: number;
  last: number;
}

const kKept = 'topple.document';
const kModels = ['pivot', 'hinge', 'rigid'] as const;
export type ModelName = (typeof kModels)[number];
/** Keys of [model] that one model alone knows; another refuses them. */
const kOwnKeys: Record<ModelName, string[]> = {
  pivot: ['integrator', 'inertia', 'hit', 'pulse_ms', 'time_step_s'],
  hinge: ['rest_tolerance', 'time_step_s'],
  rigid: ['time_step_s'],
};

/** The colours that new parts go through. */
const kHues = ['#d92b2b', '#f0821e', '#f2b928', '#3faa46', '#17a398', '#1478c8', '#7832be', '#c2185b'];

export const kEmpty = '[model]\nname = "rigid"\n';

interface Moment {
  text: string;
  /** Edits with the same one that follow one another are one step: a drag, a slider. */
  group: string;
}

export class Studio {
  text = $state(kEmpty);
  /** What the engine made of the text last; its bricks are those that are shown. */
  layout = $state.raw<ReadLayout | null>(null);
  /** Why the text is no layout now, a sentence each. */
  problems = $state.raw<string[]>([]);
  tool = $state<Tool>('select');
  /** Chosen parts, by their place in the file's order. */
  chosen = $state.raw<number[]>([]);
  style = $state<Style>({ gap: 16.5, color: kHues[0], colorTo: kHues[1], kind: '' });
  /** A new part goes on through the colours from where the last one ended, until a person chooses them. */
  colorsGoOn = true;
  saved = $state<'saved' | 'unsaved' | 'full'>('saved');
  /** How long the run takes by the quick model [s]; NaN: not known. */
  expected = $state(NaN);
  /** Of the last run of exactly this text; empty: none. */
  hash = $state('');
  /** What a link promised for this text. */
  promised = $state('');
  /** Simulated so far while a run goes on; NaN: none does. */
  runTime = $state(NaN);

  readonly engine = new EngineClient();
  private quick: EngineClient | null = null;
  private readonly history: Moment[] = [{ text: kEmpty, group: '' }];
  private at = $state(0);
  private length = $state(1);
  private stopRun: (() => void) | null = null;
  /** The run that was ordered last has come to its end. */
  over: Promise<unknown> = Promise.resolve();
  private expectTimer = 0;
  private reads = 0;
  /** The text that `layout` or `problems` are about. */
  private answered = $state(kEmpty);
  private reading: Promise<void> = Promise.resolve();
  private showing: ((layout: ReadLayout) => void) | null = null;

  /** Where each push stands: its part and its place in it, so that it stays there when bricks before it come and go. */
  private anchors: { part: string; offset: number }[] = [];

  get file(): TomlFile {
    return new TomlFile(this.text);
  }
  get title(): string {
    return this.file.blocks[0]?.string('title') || 'Untitled';
  }
  get empty(): boolean {
    return partsOf(this.file).length === 0;
  }
  get canUndo(): boolean {
    return this.at > 0;
  }
  get canRedo(): boolean {
    return this.at + 1 < this.length;
  }
  get running(): boolean {
    return !Number.isNaN(this.runTime);
  }
  get model(): ModelName {
    const name = this.file.table('model')?.string('name');
    return kModels.find((one) => one === name) ?? 'rigid';
  }

  /** @param show Called with every new answer of the engine. */
  begin(show: (layout: ReadLayout) => void): void {
    this.showing = show;
  }

  /** The document of the last time, if there was one. */
  restore(): boolean {
    const kept = localStorage.getItem(kKept);
    if (kept === null || kept === kEmpty) return false;
    this.open(kept);
    return true;
  }

  /** Another document. The one before stays in the history. */
  open(text: string, promised = ''): void {
    this.chosen = [];
    this.anchors = [];
    this.commit(text, '');
    this.promised = promised;
  }

  /** One change of the file. @param group Changes of one group that follow one another are undone together. */
  edit(change: (file: TomlFile) => void, group = ''): void {
    const file = this.file;
    change(file);
    this.commit(file.text, group);
  }

  private commit(text: string, group: string): void {
    if (text === this.text) return;
    this.history.length = this.at + 1;
    if (group && this.history[this.at].group === group) this.history[this.at] = { text, group };
    else this.history.push({ text, group });
    this.at = this.history.length - 1;
    this.length = this.history.length;
    this.take(text);
  }

  /** The end of a drag: the next change of the same sort is a step of its own. */
  endGroup(): void {
    const now = this.history[this.at];
    this.history[this.at] = { ...now, group: '' };
  }

  undo(): void {
    if (!this.canUndo) return;
    this.at--;
    this.anchors = []; // the text of that time says itself where its pushes are
    this.take(this.history[this.at].text);
    this.chosen = [];
  }
  redo(): void {
    if (!this.canRedo) return;
    this.at++;
    this.anchors = [];
    this.take(this.history[this.at].text);
    this.chosen = [];
  }

  private take(text: string): void {
    this.text = text;
    this.hash = '';
    this.promised = '';
    this.expected = NaN;
    this.keep();
    this.reading = this.read();
  }

  /** Whether the engine's answer is about the text as it is now. */
  get settled(): boolean {
    return this.answered === this.text;
  }
  /** Waits for the engine's answer to the text as it is now. */
  async settle(): Promise<void> {
    for (let waited: Promise<void> | null = null; !this.settled && waited !== this.reading; ) await (waited = this.reading);
  }

  private keep(): void {
    try {
      localStorage.setItem(kKept, this.text);
      this.saved = 'saved';
    } catch {
      this.saved = 'full';
    }
  }

  /** Asks the engine what the text is. */
  async read(): Promise<void> {
    const text = this.text;
    clearTimeout(this.expectTimer);
    if (this.empty) {
      this.layout = null;
      this.problems = [];
      this.anchors = [];
      this.answered = text;
      return;
    }
    const mine = ++this.reads;
    try {
      const layout = await this.engine.read({ text, name: 'layout.toml', overrides: [] });
      if (text !== this.text) return;
      if (this.restorePushes(layout)) return await this.read();
      this.layout = layout;
      this.problems = [];
      this.answered = text;
      this.showing?.(layout);
      this.expectTimer = window.setTimeout(() => void this.expect(text), 350);
    } catch (error) {
      if (error instanceof Superseded || mine !== this.reads || text !== this.text) return;
      this.problems = error instanceof Refused ? error.problems.map(plainProblem) : [String((error as Error).message)];
      this.answered = text;
    }
  }

  /** Pushes stay on their brick of their part. @returns Whether the text had to be changed for it. */
  private restorePushes(layout: ReadLayout): boolean {
    const { parts } = layout.recording;
    const file = this.file;
    const pushes = file.list('push');
    let changed = false;
    pushes.forEach((push, i) => {
      const anchor = this.anchors[i];
      const part = anchor && parts.find((one) => one.name === anchor.part);
      if (!part) return;
      const brick = part.first + Math.min(anchor.offset, part.count - 1);
      if (brick === push.number('brick', 0)) return;
      push.set('brick', brick);
      changed = true;
    });
    if (changed) {
      this.text = file.text;
      this.history[this.at] = { ...this.history[this.at], text: this.text };
      this.keep();
      return true;
    }
    this.anchors = pushes.map((push) => {
      const brick = push.number('brick', 0);
      const part = parts.find((one) => brick >= one.first && brick < one.first + one.count);
      return { part: part?.name ?? '', offset: part ? brick - part.first : 0 };
    });
    return false;
  }

  /** Puts the push on a brick of what is shown. */
  pushBrick(brick: number): void {
    this.anchors = [];
    this.edit((file) => {
      const push = file.list('push')[0];
      if (push) push.set('brick', brick);
      else this.addPush(file, brick);
    });
  }

  /** One push more, on a brick that nothing reaches. */
  pushMore(brick: number): void {
    this.anchors = [];
    this.edit((file) => this.addPush(file, brick, true));
  }

  /** Changes a number of the i-th push. */
  setPush(index: number, key: string, value: number): void {
    if (key === 'brick') this.anchors = [];
    this.edit((file) => file.list('push')[index]?.set(key, value), `push ${index} ${key}`);
  }
  removePush(index: number): void {
    this.anchors = [];
    this.edit((file) => {
      const push = file.list('push')[index];
      if (push) file.remove(push);
    });
  }

  private addPush(file: TomlFile, brick: number, last = false): void {
    const block = new Block(`[[push]]\nbrick = ${brick}\nangular_speed_rad_s = 4\n\n`);
    const pushes = file.list('push');
    const at = last && pushes.length ? file.blocks.indexOf(pushes[pushes.length - 1]) + 1 : file.blocks.findIndex((one) => one.name !== '');
    if (at < 0) file.append(block.text);
    else file.blocks.splice(at, 0, block);
  }

  /** A new part at the end; the first of all brings a push along. */
  add(...texts: string[]): void {
    this.edit((file) => {
      const pushed = /^\[\[ball\]\]|^starter = "pushes"$/m.test(texts[0]); // by itself
      if (file.list('push').length === 0 && partsOf(file).length === 0 && !pushed) this.addPush(file, 0);
      const model = file.table('model');
      if (model) file.remove(model);
      for (const text of texts) file.append(text);
      if (model) file.append(model.text.trimEnd() + '\n');
      const all = partsOf(file).length;
      this.chosen = texts.map((_, i) => all - texts.length + i);
    });
    if (!this.colorsGoOn || !/^color_to/m.test(texts[0])) return;
    const next = kHues[(kHues.indexOf(this.style.colorTo) + 1) % kHues.length];
    this.style = { ...this.style, color: this.style.colorTo, colorTo: next };
  }

  chosenBlocks(file: TomlFile): Block[] {
    const parts = partsOf(file);
    return this.chosen.map((i) => parts[i]).filter(Boolean);
  }

  /** Bricks of the i-th part, null while the engine has not answered. */
  spanOf(index: number): Span | null {
    const made = this.madeBy(index);
    if (made.length === 0) return null;
    return { first: Math.min(...made.map((one) => one.first)), last: Math.max(...made.map((one) => one.first + one.count - 1)) };
  }

  /** What a part of the file became: one line of bricks, or those of a field, row by row. */
  madeBy(index: number): Part[] {
    const file = this.file;
    const part = partsOf(file)[index];
    if (!part || !this.layout) return [];
    const name = nameOf(file, part);
    return this.layout.recording.parts.filter((one) => one.name === name || one.name.startsWith(`${name} `));
  }

  /** Which part made a brick, -1 if none did. */
  partOf(brick: number): number {
    const part = this.layout?.recording.parts.find((one) => brick >= one.first && brick < one.first + one.count);
    if (!part) return -1;
    const file = this.file;
    return partsOf(file).findIndex((one) => {
      const name = nameOf(file, one);
      return part.name === name || part.name.startsWith(`${name} `);
    });
  }

  /** The middle of the chosen parts' bricks [mm]. */
  middleOfChosen(): Point {
    let [n, x, y] = [0, 0, 0];
    for (const index of this.chosen) {
      const span = this.spanOf(index);
      if (!span || !this.layout) continue;
      const { foot } = this.layout.recording.bricks;
      for (let brick = span.first; brick <= span.last; brick++, n++) {
        x += foot[3 * brick] * 1000;
        y += foot[3 * brick + 1] * 1000;
      }
    }
    return n ? { x: x / n, y: y / n } : { x: 0, y: 0 };
  }

  move(dx: number, dy: number, group = 'move'): void {
    this.edit((file) => this.chosenBlocks(file).forEach((part) => movePart(part, dx, dy)), group);
  }
  turn(degrees: number): void {
    const about = this.middleOfChosen();
    this.edit((file) => this.chosenBlocks(file).forEach((part) => turnPart(part, about, degrees)), 'turn');
  }
  mirror(): void {
    const { x } = this.middleOfChosen();
    this.edit((file) => this.chosenBlocks(file).forEach((part) => mirrorPart(part, x)));
  }
  remove(): void {
    this.edit((file) => {
      this.chosenBlocks(file).forEach((part) => file.remove(part));
      if (partsOf(file).length === 0) file.list('push').forEach((push) => file.remove(push));
    });
    this.chosen = [];
  }
  duplicate(): void {
    const blocks = this.chosenBlocks(this.file).map((part) => {
      const copy = new Block(part.text.replace(/^\s*(#.*\n)*/, '').trimEnd() + '\n');
      movePart(copy, 0, -60);
      return copy.text;
    });
    const { style } = this;
    if (blocks.length) this.add(...blocks);
    this.style = style; // a copy takes no colour
  }
  /** Sets a value of every chosen part that knows the key. */
  set(key: string, value: string | number, group = key): void {
    this.edit((file) => {
      for (const part of this.chosenBlocks(file).filter((one) => knows(one, key))) {
        if (value === '') part.remove(key);
        else part.set(key, value);
      }
    }, group);
  }
  setTitle(title: string): void {
    this.edit((file) => {
      if (file.blocks.length === 0 || file.blocks[0].name) file.blocks.unshift(new Block('title = ""\n\n'));
      file.blocks[0].set('title', title);
    }, 'title');
  }
  setModel(name: ModelName): void {
    this.edit((file) => {
      const table = file.needTable('model');
      table.set('name', name);
      for (const key of Object.values(kOwnKeys).flat()) if (key !== 'name' && table.has(key)) table.remove(key);
    });
  }
  pointsOf(index: number): Point[] {
    const part = partsOf(this.file)[index];
    return part ? pointsOf(part) : [];
  }

  /** Why a text is no layout, a sentence each; none where it is one, or the engine is not there to say. */
  async problemsOf(text: string, name: string): Promise<string[]> {
    this.quick ??= new EngineClient();
    try {
      await this.quick.ready;
      await this.quick.read({ text, name, overrides: [] });
      return [];
    } catch (error) {
      return error instanceof Refused ? error.problems : [];
    }
  }

  /** How long it will take, by the quickest model that carries a wave; nothing is said where it cannot take the layout. */
  private async expect(text: string): Promise<void> {
    if (!this.layout || this.layout.bricks > 20000) return;
    this.quick ??= new EngineClient();
    // The model that was chosen takes over where hinge refuses, if the layout is small enough for a try.
    const models = this.layout.bricks <= 400 ? (['hinge', this.model] as const) : (['hinge'] as const);
    for (const model of models) {
      try {
        const source = { text: withModel(text, model), name: 'layout.toml', overrides: [] };
        const { loaded } = await this.quick.run(source).finished;
        if (text === this.text) this.expected = lastArrival(loaded.recording) + 0.3;
        return;
      } catch {
        continue;
      }
    }
  }

  /** Runs the layout. @returns Null where the engine refuses: the problems are said. */
  async run(watch: RunWatch, model?: ModelName): Promise<Finished | null> {
    const text = this.text;
    this.runTime = 0;
    const source = { text: model ? withModel(text, model) : text, name: 'layout.toml', overrides: [] };
    const run = this.engine.run(source, {
      grown: (loaded) => watch.grown(loaded),
      progress: (time, arrived) => {
        this.runTime = time;
        watch.progress(time, arrived);
      },
    }, nativeFor(this.layout?.bricks ?? 0));
    this.stopRun = run.stop;
    this.over = run.finished.catch(() => undefined);
    try {
      const finished = await run.finished;
      const whole = finished.loaded.recording.end.reason !== 5;
      if (text === this.text && whole && !model) this.hash = finished.hash;
      return finished;
    } catch (error) {
      if (error instanceof Superseded) return null; // stopped before it began
      this.problems = error instanceof Refused ? error.problems.map(plainProblem) : [(error as Error).message];
      return null;
    } finally {
      this.runTime = NaN;
      this.stopRun = null;
    }
  }

  stop(): void {
    this.stopRun?.();
  }
}

/** What the program that serves the page has written into its head: null where the page comes from elsewhere. */
export function toldByProgram(): HTMLMetaElement | null {
  return document.querySelector<HTMLMetaElement>('meta[name=topple-native]');
}

/** Where the program that serves the page runs long layouts; empty: the page comes from elsewhere, or the layout is short. */
function nativeFor(bricks: number): string {
  const told = toldByProgram();
  return told && bricks >= Number(told.dataset.bricks) ? told.content : '';
}

/** The same layout by another model, without the settings that only the first one knows. */
export function withModel(text: string, name: ModelName): string {
  const file = new TomlFile(text);
  const table = file.needTable('model');
  if (table.string('name') === name) return file.text;
  for (const key of table.keys()) if (key !== 'name') table.remove(key);
  table.set('name', name);
  return file.text;
}

/** Without the place in the file, which a person who draws does not see. */
function plainProblem(problem: string): string {
  return problem.replace(/^layout\.toml(:\d+)*: /, '');
}
