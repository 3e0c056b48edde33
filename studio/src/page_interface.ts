/**
 * `window.topple`: what tests and scripts may ask of the page. Times are seconds of the run, angles radians, bricks numbers in layout
 * order. Nothing in the page depends on it.
 */

import type { Player } from './player/player.svelte.ts';
import type { Stage } from './player/stage.svelte.ts';
import { Vector3 } from 'three';
import { makeFilm, type FilmOrder } from './film/film.ts';
import { turnAt } from './recording/motion.ts';
import { lastNotOver } from './recording/wave.ts';
import type { Studio } from './draw/studio.svelte.ts';
import type { Sound } from './player/sound.svelte.ts';
import type { Way } from './view/rig.ts';

export type Mode = 'draw' | 'watch' | 'compare';

export interface PageInterface {
  /** Whether a recording is open. */
  readonly loaded: boolean;
  readonly bricks: number;
  readonly time: number;
  readonly duration: number;
  readonly playing: boolean;
  /** The chosen brick, -1: none. */
  readonly chosen: number;
  /** Bricks past their tip angle for good. */
  readonly fallen: number;
  /** Where the still is, 0 to 1. */
  readonly still: number;
  /** What the page's own code cost in the last frames [ms]. */
  readonly frameCosts: number[];
  seek(time: number): void;
  /** Stops playing, whether it goes on or has come to its end by itself. */
  pause(): void;
  choose(brick: number): void;
  setWay(way: Way): void;
  /** Tilt that the tracks give for a brick at the playhead's time; > 0 the way it heads. */
  tilt(brick: number): number;
  /** Tilt of the brick as it is drawn: from the orientation that the graphics card was given. */
  drawnTilt(brick: number): number;
  /** Height of the brick's middle as it is drawn [m]. */
  drawnHeight(brick: number): number;
  /** Middle of a brick in the page [CSS px], null out of sight. */
  placeOf(brick: number): { x: number; y: number } | null;
  /** Where bricks were put down: x y z of each [m], and their headings [rad]. */
  readonly feet: Float64Array;
  readonly headings: Float64Array;
  /** Turns the camera about what it looks at [rad]. */
  swing(angle: number): void;
  /** Looks from a place at a place [m, in the layout's axes]. */
  lookFrom(position: [number, number, number], target: [number, number, number]): void;
  readonly mode: Mode;
  /** Whether the camera stands where it is meant to: it neither flies nor is about to. */
  readonly arrived: boolean;
  /** The layout being drawn. */
  readonly text: string;
  /** Its bricks, as the engine put them down. */
  readonly drawn: number;
  /** Whether bricks and doubts are those of the text as it is now. */
  readonly settled: boolean;
  /** What the engine says against it. */
  readonly doubts: readonly string[];
  /** Of the last run of the drawn layout, 16 hexadecimal digits. */
  readonly hash: string;
  readonly clicks: number;
  /** A place on the table [mm] in the page [CSS px]. */
  pixelAt(x: number, y: number): { x: number; y: number } | null;
  /** Runs a layout by the page's engine and gives its hash. */
  runHash(text: string, overrides?: string[]): Promise<string>;
  /** Frames of a film as PNG or a whole film: see film/film.ts. */
  film(order: FilmOrder, progress?: (done: number, of: number) => void): Promise<Uint8Array>;
  /** Averages a still of so many frames. */
  finishStill(frames?: number): Promise<void>;
}

declare global {
  interface Window {
    topple: PageInterface;
  }
}

export function installPageInterface(player: Player, stage: Stage, studio: Studio, page: { mode: () => Mode; arrived: () => boolean; sound: Sound }): void {
  stage.onFrame = () => page.sound.follow();
  window.topple = {
    get loaded() { return player.loaded !== null && player.recording!.bricks.count > 0 && stage.playhead !== null; },
    get bricks() { return player.recording?.bricks.count ?? 0; },
    get time() { return player.time; },
    get duration() { return player.duration; },
    get playing() { return player.playing; },
    get chosen() { return player.chosen; },
    get fallen() { return player.loaded ? lastNotOver(player.loaded.falls, player.time) + 1 : 0; },
    get still() { return stage.stillPart; },
    get feet() { return player.recording?.bricks.foot ?? new Float64Array(0); },
    get headings() { return player.recording?.bricks.heading ?? new Float64Array(0); },
    get frameCosts() { return stage.costs; },
    get mode() { return page.mode(); },
    get arrived() { return page.arrived(); },
    get text() { return studio.text; },
    get drawn() { return studio.layout?.bricks ?? 0; },
    get settled() { return studio.settled; },
    get doubts() { return studio.layout?.doubts.map((doubt) => doubt.words) ?? []; },
    get hash() { return studio.hash; },
    get clicks() { return page.sound.played; },
    pixelAt: (x, y) => {
      const at = stage.view?.pixelOf(new Vector3(x / 1000, y / 1000, 0));
      if (!at || !stage.view) return null;
      const box = stage.view.canvas.getBoundingClientRect();
      return { x: box.left + at.x, y: box.top + at.y };
    },
    runHash: async (text, overrides = []) => {
      await studio.engine.ready;
      return (await studio.engine.run({ text, name: 'layout.toml', overrides }).finished).hash;
    },
    film: (order, progress) => makeFilm(player, stage, order, { progress: progress ?? (() => undefined), cancelled: () => false }),
    seek: (time) => {
      player.seek(time);
      stage.wake();
    },
    pause: () => void (player.playing = false),
    choose: (brick) => player.choose(brick),
    setWay: (way) => stage.setWay(way),
    tilt: (brick) => {
      const turn = { angle: 0, rate: 0, acceleration: 0 };
      if (player.recording) turnAt(player.recording, brick, player.time, turn);
      return turn.angle;
    },
    drawnTilt: (brick) => {
      const [x, y] = stage.playhead?.turn.subarray(4 * brick, 4 * brick + 2) ?? [0, 0];
      return Math.acos(Math.max(-1, 1 - 2 * (x * x + y * y)));
    },
    drawnHeight: (brick) => stage.playhead?.position[3 * brick + 2] ?? NaN,
    placeOf: (brick) => {
      const outline = stage.view?.outline(brick);
      if (!outline || !stage.view) return null;
      const box = stage.view.canvas.getBoundingClientRect();
      const n = outline.points.length;
      const [x, y] = [0, 1].map((axis) => outline.points.reduce((sum, p) => sum + p[axis] / n, 0));
      return { x: box.left + x, y: box.top + y };
    },
    lookFrom: (position, target) => {
      stage.lookFrom(position, target);
    },
    swing: (angle) => {
      stage.view?.rig.swing(angle);
      stage.view?.changed();
      stage.wake();
    },
    finishStill: async (frames) => {
      stage.drawFrame(0);
      await stage.view?.finishStill(frames);
      stage.stillPart = 1;
    },
  };
}
