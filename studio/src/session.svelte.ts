/** What the page is doing: drawing, watching or comparing; what is open, where it came from, and how one becomes the other. */

import { hashWords, readFragment } from './draw/link.ts';
import { isImage } from './draw/picture.ts';
import { toldByProgram, type Studio } from './draw/studio.svelte.ts';
import type { Finished } from './engine/client.ts';
import type { Mode } from './page_interface.ts';
import { openRecording } from './player/opening.ts';
import type { Player, Summary } from './player/player.svelte.ts';
import type { Stage } from './player/stage.svelte.ts';
import { emptyRecording } from './recording/empty.ts';
import type { Recording } from './recording/types.ts';
import type { Order } from './recording/worker.ts';
import type { Theme } from './view/view.ts';

/** Problems of a file that are said at once. */
const kProblems = 6;

/** What only the page's elements know. */
export interface Screen {
  /** Null: there is no WebGL. */
  canvas: () => HTMLCanvasElement | null;
  theme: () => Theme;
  /** Gives the view the size of its place. */
  fit: () => void;
  /** Another document or mode: what was drawn over the last one goes. */
  clear: () => void;
  /** Asks how an image is to become a field. */
  picture: (image: File) => void;
}

export class Session {
  mode = $state<Mode>('watch');
  /** Opening takes long. */
  slow = $state(false);
  /** Why the engine is not there; empty: it is, or is coming. */
  noEngine = $state('');
  /** One sentence for a while: a link was copied, a hash is the same. */
  note = $state('');
  /** The run of the drawn layout that is shown; null: a recording from elsewhere, or none. */
  finished = $state.raw<Finished | null>(null);
  /** Called when a recording has been opened. */
  opened: () => void = () => undefined;
  private cancelOpening: (() => void) | null = null;
  private frameNext = true;
  private noteTimer = 0;
  private starting = false;
  /** Counts what is brought: of several files or links only the last one is opened, whichever is read first. */
  private brought = 0;
  /** Counts what is shown to be watched: a run that goes on while something else is opened is not shown over it. */
  private shown = 0;
  /** The camera is about to come nearer: once the view has the size in which a run is watched. */
  private nearing = 0;

  constructor(
    private readonly player: Player,
    private readonly stage: Stage,
    private readonly studio: Studio,
    private readonly screen: Screen,
  ) {
    studio.begin((layout) => {
      if (this.mode === 'draw') this.showLayout(layout.recording);
    });
  }

  say(words: string): void {
    this.note = words;
    clearTimeout(this.noteTimer);
    this.noteTimer = window.setTimeout(() => (this.note = ''), 6000);
  }

  // ---- Opening ----

  /** What the address says: a layout after '#', else the recording beside the page, else the table. */
  async begin(): Promise<void> {
    this.stage.open(emptyRecording(), this.screen.canvas(), this.screen.theme());
    this.screen.fit();
    if (await this.openFragment()) return;
    if (this.alone) await this.beginDrawing();
    else this.open({ url: new URL('recording.topple', document.baseURI).href });
  }

  /** The program serves the page without a recording: one need not ask. */
  private get alone(): boolean {
    return toldByProgram()?.dataset.recording === 'no';
  }

  /** Whether the camera stands where it is meant to: it neither flies nor is about to. */
  get arrived(): boolean {
    return this.nearing === 0 && !this.stage.view?.rig.flying;
  }

  open(order: Order): void {
    this.cancelOpening?.();
    this.cancelOpening = openRecording(order, this.player, {
      slow: (is) => (this.slow = is),
      opened: () => {
        this.shown++;
        this.studio.stop();
        this.finished = null;
        this.mode = 'watch';
        this.showFresh(this.player.recording as Recording);
        this.opened();
      },
      absent: () => void this.beginDrawing(),
    });
  }

  cancel(): void {
    this.cancelOpening?.();
    void this.beginDrawing();
  }

  async openFile(file: File): Promise<void> {
    const mine = ++this.brought;
    if (isImage(file)) {
      this.setMode('draw');
      return this.screen.picture(file);
    }
    const begins = await file.slice(0, 6).text();
    if (/\.toml$/i.test(file.name)) {
      const text = await file.text();
      if (mine === this.brought) await this.takeLayout(text, file.name);
      return;
    }
    if (!/\.topple$/i.test(file.name) && begins !== 'TOPPLE') {
      this.player.failure = `${file.name} is neither a layout (.toml) nor a recording (.topple) nor an image.`;
      return;
    }
    const bytes = await file.arrayBuffer();
    if (mine !== this.brought) return;
    this.player.summary = null;
    this.open({ bytes });
  }

  /** Opens what somebody brought, if it is a layout; else says every problem and leaves what is open. @returns Whether it is one. */
  private async takeLayout(text: string, name: string, promised = ''): Promise<boolean> {
    const mine = ++this.brought;
    const problems = await this.studio.problemsOf(text, name);
    if (mine !== this.brought) return true;
    if (problems.length === 0) this.openLayout(text, promised);
    else {
      const more = problems.length > kProblems ? [`and ${problems.length - kProblems} more.`] : [];
      this.player.failure = [`${name} cannot be opened.`, ...problems.slice(0, kProblems), ...more].join('\n');
    }
    return problems.length === 0;
  }

  /** Another layout to draw on; the one before can be had back by undo. */
  openLayout(text: string, promised = ''): void {
    this.cancelOpening?.();
    this.frameNext = true;
    this.player.failure = '';
    this.setMode('draw', true);
    this.studio.tool = 'select';
    this.studio.open(text, promised);
  }

  /** A field that shows a picture, beside what is on the table. */
  async addPicture(text: string): Promise<void> {
    this.studio.add(text);
    this.studio.tool = 'select';
    this.studio.chosen = []; // what marks the chosen would lie over the picture
    await this.studio.settle();
    this.stage.frameAll();
  }

  async fetchSummary(): Promise<void> {
    if (this.alone) return;
    try {
      const answer = await fetch('summary.json');
      const text = answer.ok ? await answer.text() : ''; // empty where plain files hold none
      if (text) this.player.summary = JSON.parse(text) as Summary;
    } catch {
      this.player.summary = null; // the page does without
    }
  }

  async beginDrawing(): Promise<void> {
    this.setMode('draw', true);
    this.studio.restore();
    if (this.studio.empty) {
      this.studio.tool = 'curve'; // "Draw a line": at once
      this.showLayout(null);
    }
    await this.studio.engine.ready.catch((error: Error) => (this.noEngine = error.message));
  }

  /** @returns Whether the address holds a layout. */
  async openFragment(): Promise<boolean> {
    if (!location.hash.includes('layout=')) return false;
    try {
      const shared = await readFragment(location.hash);
      if (!shared) return false;
      if (!(await this.takeLayout(shared.text, 'The layout in this link', shared.hash))) await this.beginDrawing();
      await this.studio.engine.ready.catch((error: Error) => (this.noEngine = error.message));
    } catch (error) {
      await this.beginDrawing();
      this.player.failure = (error as Error).message;
    }
    return true;
  }

  // ---- What the view shows ----

  private showFresh(recording: Recording): void {
    const { stage } = this;
    this.screen.clear();
    stage.replaceFresh(recording);
    this.screen.fit();
    stage.setDrawing(this.mode === 'draw');
    stage.frameAll(true, true);
  }

  private showLayout(recording: Recording | null): void {
    const shown = recording ?? emptyRecording();
    this.player.show(shown);
    if (this.frameNext) this.showFresh(shown);
    else this.stage.replace(shown);
    this.frameNext = false;
  }

  /** @param bare The layout of a recording that is open is not taken over. */
  setMode(next: Mode, bare = false): void {
    if (this.mode === next) return;
    const { player, stage, studio } = this;
    if (next === 'compare' && !bare && this.fromElsewhere) {
      this.takeOver(this.fromElsewhere);
      const { mode } = this;
      void studio.settle().then(() => this.mode === mode && this.setMode(next, true)); // compared is what the engine has read
      return;
    }
    this.mode = next;
    this.screen.clear();
    player.playing = false;
    stage.setDrawing(next === 'draw');
    if (next === 'draw') {
      this.shown++;
      studio.stop();
      if (!bare && this.fromElsewhere) this.editRecording(this.fromElsewhere);
      else if (!bare) this.showLayout(studio.layout?.recording ?? null);
    } else if (next === 'watch' && this.finished) this.showRun(this.finished);
  }

  /** The recipe of a recording that came from elsewhere and says its layout. */
  private get fromElsewhere(): Recording['recipe'] | null {
    const recipe = this.player.recording?.recipe;
    return !this.finished && recipe?.layoutText && recipe.model ? recipe : null;
  }

  private takeOver({ layoutText, model }: Recording['recipe']): void {
    this.studio.open(layoutText);
    if (model !== this.studio.model && (model === 'pivot' || model === 'hinge' || model === 'rigid')) this.studio.setModel(model);
  }

  /** The layout of a recording that came from elsewhere, for drawing on. */
  private editRecording(recipe: Recording['recipe']): void {
    this.frameNext = true;
    this.takeOver(recipe);
    if (this.studio.settled && this.studio.layout) this.showLayout(this.studio.layout.recording);
  }

  private showRun(run: Finished): void {
    this.player.grow(run.loaded, true);
    if (this.stage.playhead?.recording.bricks.count === run.loaded.recording.bricks.count) this.stage.grow(run.loaded.recording);
    else this.stage.replaceFresh(run.loaded.recording);
  }

  async topple(): Promise<void> {
    const { studio, player, stage } = this;
    if (this.starting) return;
    this.starting = true;
    await studio.settle(); // a tap may come before the engine has seen the last stroke
    if (this.mode === 'draw') await studio.over; // and before a run that was stopped has heard it
    this.starting = false;
    const { layout, promised } = studio;
    if (this.mode !== 'draw' || studio.problems.length || studio.empty || !layout || studio.running || layout.doubts.some((one) => one.kind === 'overlap')) return;
    const mine = ++this.shown;
    this.finished = null;
    player.show(layout.recording);
    stage.replace(layout.recording);
    this.mode = 'watch';
    this.screen.clear();
    stage.setDrawing(false);
    this.comeNear(mine);
    player.growing = true;
    player.expected = studio.expected + 0.7; // and a second for what still settles
    player.speed = 1;
    player.playing = true;
    const run = await studio.run({
      grown: (loaded) => {
        if (mine !== this.shown) return;
        player.grow(loaded, false);
        stage.grow(loaded.recording);
      },
      progress: () => undefined,
    });
    if (mine !== this.shown) return;
    player.growing = false;
    if (!run) return this.setMode('draw');
    this.finished = run;
    const { playing } = player;
    this.showRun(run);
    if (playing) player.play();
    if (promised) this.say(this.promiseWords(promised, run.hash));
  }

  /** Two frames from now the view has the size in which a run is watched. */
  private comeNear(run: number): void {
    this.nearing++;
    requestAnimationFrame(() => requestAnimationFrame(() => {
      this.nearing--;
      if (run === this.shown && this.mode === 'watch') this.stage.closeIn(); // a run that was refused or left at once leaves the table as it was
    }));
  }

  private promiseWords(promised: string, hash: string): string {
    if (promised === hash) return `Same result as the sender’s (hash ${hashWords(hash)}).`;
    return `The sender’s result was another one: hash ${hashWords(promised)} there, ${hashWords(hash)} here.`;
  }
}
