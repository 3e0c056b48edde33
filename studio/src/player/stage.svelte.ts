/** Ties the player's time to the bricks' poses and to the view, and runs the page's one loop; it sleeps when nothing changes. */

import { Vector3 } from 'three';
import { Playhead } from '../recording/playhead.ts';
import { lastNotOver } from '../recording/wave.ts';
import type { Recording } from '../recording/types.ts';
import { View, type Theme } from '../view/view.ts';
import type { Spot, Way } from '../view/rig.ts';
import type { Player } from './player.svelte.ts';

export class Stage {
  /** Counts drawn frames, so that what lies over the view follows it. */
  frames = $state(0);
  way = $state<Way>('orbit');
  /** 0 to 1, of the still. */
  stillPart = $state(0);
  view: View | null = null;
  playhead: Playhead | null = null;
  /** What the page's own code costs in a frame, without the graphics card's share: the last 240 frames [ms]. */
  readonly costs: number[] = [];
  /** A film has the view: the page's own loop stands still. */
  filming = false;
  /** Puts the view back to the page's size. */
  resized: () => void = () => undefined;
  private asked = 0;
  private last = 0;

  constructor(readonly player: Player) {}

  /** @param canvas Null where there is no WebGL. */
  open(recording: Recording, canvas: HTMLCanvasElement | null, theme: Theme): void {
    this.close();
    this.playhead = new Playhead(recording, middleOf(recording));
    if (canvas) {
      this.view = new View(canvas, recording, this.playhead, () => this.wake());
      this.view.setTheme(theme);
      this.view.stills = new URLSearchParams(location.search).get('still') !== 'off';
    }
    this.way = 'orbit';
    this.wake();
  }

  /** Called with every frame: the sound. */
  onFrame: (() => void) | null = null;

  /** Another document in the same view. */
  replaceFresh(recording: Recording): void {
    this.playhead = new Playhead(recording, middleOf(recording));
    this.view?.replace(recording, this.playhead);
    if (this.way !== 'top') this.way = 'orbit';
    this.wake();
  }

  /** Where a brick was put down; null for one that is not there. */
  placeOf(brick: number): Spot | null {
    const count = this.playhead?.recording.bricks.count ?? 0;
    return brick >= 0 && brick < count ? this.spotOf(brick) : null;
  }

  /** Brings a place near. */
  flyTo(spot: Spot): void {
    this.view?.rig.closeUp(spot);
    this.wake();
  }

  /** Another recording in the same view: what is drawn changes, the camera stays. */
  replace(recording: Recording): void {
    const origin = this.playhead?.origin ?? middleOf(recording);
    this.playhead = new Playhead(recording, origin);
    this.view?.replace(recording, this.playhead);
    this.wake();
  }

  /** More of the run that is shown. */
  grow(recording: Recording): void {
    if (!this.playhead) return;
    this.playhead = new Playhead(recording, this.playhead.origin, this.playhead);
    this.playhead.moveTo(this.player.time);
    this.view?.follow(this.playhead);
    this.wake();
  }

  close(): void {
    cancelAnimationFrame(this.asked);
    this.asked = 0;
    this.view?.dispose();
    this.view = null;
  }

  /** Asks for frames until nothing changes any more. */
  wake(): void {
    if (this.asked || this.filming) return;
    this.last = performance.now();
    this.asked = requestAnimationFrame((now) => this.tick(now));
  }

  private tick(now: number): void {
    const dt = Math.min(0.25, Math.max(0, (now - this.last) / 1000));
    this.last = now;
    this.asked = 0;
    if (this.view && !this.view.ready) return; // it wakes us
    this.player.advance(dt);
    this.onFrame?.();
    const more = this.drawFrame(dt);
    if (more || this.player.playing) this.asked = requestAnimationFrame((next) => this.tick(next));
  }

  /** Puts bricks and camera where they belong now, and draws. */
  drawFrame(dt: number): boolean {
    const { view, playhead, player } = this;
    if (!playhead) return false;
    const began = performance.now();
    if (playhead.time !== player.time) {
      playhead.moveTo(player.time);
      view?.changed();
    }
    const spot = this.way === 'front' ? this.frontSpot() : null;
    const more = view?.draw(dt, spot?.place ?? null) ?? false;
    this.frames++;
    this.stillPart = view?.stillPart ?? 0;
    this.costs.push(performance.now() - began);
    if (this.costs.length > 240) this.costs.shift();
    return more;
  }

  /** Where the wave is now, in the view's coordinates: moved evenly from each brick to the next. */
  frontSpot(): Spot | null {
    const { front, time } = this.player;
    const { playhead } = this;
    if (!playhead || !front) return null;
    const i = front.time.length ? lastNotOver(front.time, time) : -1;
    if (i < 0) return this.spotOf(this.player.frontBrick());
    const here = this.spotOf(front.brick[i]);
    if (i + 1 < front.time.length) {
      const part = (time - front.time[i]) / (front.time[i + 1] - front.time[i]);
      here.place.lerp(this.spotOf(front.brick[i + 1]).place, part);
    }
    return here;
  }

  /** Where a brick was put down, at a third of its height. */
  private spotOf(brick: number): Spot {
    const { recording, origin } = this.playhead as Playhead;
    const { foot, heading } = recording.bricks;
    const third = 0.35 * recording.kinds[recording.bricks.kind[brick]].height;
    const [x, y, z] = [0, 1, 2].map((axis) => foot[3 * brick + axis] - origin[axis]);
    return { place: new Vector3(x, y, z + third), heading: heading[brick] };
  }

  setWay(way: Way): void {
    this.way = way;
    const rig = this.view?.rig;
    if (!rig || !this.playhead) return;
    if (way === 'orbit') rig.orbit();
    if (way === 'top') rig.top();
    if (way === 'front') rig.followFront(this.frontSpot() as Spot);
    if (way === 'eye') rig.brickEye(this.spotOf(this.eyeBrick()));
    this.wake();
  }

  /** The chosen brick, or one that the wave will pass before long. */
  private eyeBrick(): number {
    const { chosen, front, time } = this.player;
    if (chosen >= 0) return chosen;
    if (!front || front.time.length === 0) return 0;
    const ahead = Math.max(0, lastNotOver(front.time, time)) + 8;
    return front.brick[Math.min(front.time.length - 1, ahead)];
  }

  /** Looks from a place at a place [m, in the layout's axes], at once. */
  lookFrom(position: [number, number, number], target: [number, number, number]): void {
    const origin = new Vector3(...(this.playhead?.origin ?? [0, 0, 0]));
    this.way = 'orbit';
    this.view?.rig.orbit();
    this.view?.rig.cut({ position: new Vector3(...position).sub(origin), target: new Vector3(...target).sub(origin) });
    this.wake();
  }

  /** Comes nearer to a run that is small in the view, and rides with the wave of one that is too long to be looked at as a whole. */
  closeIn(): void {
    if (this.view && !this.view.rig.closeIn()) this.setWay('front');
    this.wake();
  }

  /** @param fresh Another run. */
  frameAll(cut = false, fresh = false): void {
    const rig = this.view?.rig;
    if (this.way !== 'top') {
      this.way = 'orbit';
      rig?.orbit();
    }
    rig?.frameAll(cut, fresh);
    this.wake();
  }

  /** Lines on the table, and the camera as it was when one drew there. */
  setDrawing(drawing: boolean): void {
    if (!this.view) return;
    this.view.drawing = drawing;
    this.way = this.view.rig.way;
    this.wake();
  }
}

/** Middle of the bricks' feet on the table [m]: the view's origin. */
export function middleOf(recording: Recording): [number, number, number] {
  const { foot, count } = recording.bricks;
  let [lowX, highX, lowY, highY] = [Infinity, -Infinity, Infinity, -Infinity];
  for (let brick = 0; brick < count; brick++) {
    lowX = Math.min(lowX, foot[3 * brick]);
    highX = Math.max(highX, foot[3 * brick]);
    lowY = Math.min(lowY, foot[3 * brick + 1]);
    highY = Math.max(highY, foot[3 * brick + 1]);
  }
  if (count === 0) return [0, 0, 0];
  return [0.5 * (lowX + highX), 0.5 * (lowY + highY), 0];
}
