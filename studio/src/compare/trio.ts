/** Several runs of one layout in one canvas: a place for each, one camera for all, one light, and each run's bricks at the same time. */

import { HalfFloatType, Scene, Vector2, type Vector3, WebGLRenderer, WebGLRenderTarget } from 'three';
import { Playhead } from '../recording/playhead.ts';
import type { Recording } from '../recording/types.ts';
import { BrickMesh } from '../view/bricks.ts';
import { FinalPass } from '../view/final_pass.ts';
import { kMoods, Light, type Bounds } from '../view/light.ts';
import { Rig } from '../view/rig.ts';
import { Table } from '../view/table.ts';
import { boundsOf, framePoints, isSoftware, kExposure, tallest, type Theme } from '../view/view.ts';

/** In CSS pixels from the canvas's upper left corner. */
export interface Place {
  x: number;
  y: number;
  width: number;
  height: number;
}

interface Shown {
  recording: Recording;
  playhead: Playhead;
  bricks: BrickMesh;
}

export class Trio {
  /** Time of every run [s]. */
  time = 0;
  places: Place[] = [];
  readonly rig: Rig;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly light: Light;
  private readonly table: Table;
  private readonly pass: FinalPass;
  private readonly live: WebGLRenderTarget;
  private readonly software: boolean;
  private readonly shown: (Shown | undefined)[] = [];
  private readonly origin: readonly [number, number, number];
  private readonly bounds: Bounds;
  private readonly brickHeight: number;
  private theme: Theme = 'light';
  private asked = 0;
  private last = 0;

  /**
   * @param layout Its bricks as they stand: what each place shows until its run is there.
   * @param origin Near them [m].
   * @param forward Which way the camera looks at first; null: as suits the bricks.
   */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly layout: Recording,
    origin: readonly [number, number, number],
    count: number,
    forward: Vector3 | null,
  ) {
    this.origin = origin;
    this.renderer = new WebGLRenderer({ canvas, antialias: false });
    this.renderer.autoClear = false;
    this.software = isSoftware(this.renderer);
    this.brickHeight = tallest(layout);
    const points = framePoints(layout, origin);
    this.bounds = boundsOf(points);
    this.rig = new Rig(canvas, points, this.brickHeight, () => this.wake());
    this.rig.controls.zoomToCursor = false; // the pointer is in one of several places
    this.rig.forward = forward;
    this.rig.insets = { left: 0.05, right: 0.05, top: 0.2, bottom: 0.08 };
    this.light = new Light(this.scene, this.renderer, this.software ? 1024 : 2048);
    this.light.useLive();
    this.light.placeSun(this.rig.defaultForward());
    this.table = new Table(this.scene);
    this.pass = new FinalPass(this.renderer);
    this.live = new WebGLRenderTarget(1, 1, { type: HalfFloatType, samples: this.software ? 0 : 4 });
    for (let i = 0; i < count; i++) this.show(i, layout);
  }

  /** Another recording of the same bricks in a place; null: the layout as it stands. */
  show(place: number, recording: Recording | null): void {
    const wanted = recording ?? this.layout;
    const before = this.shown[place];
    if (before?.recording === wanted) return;
    if (before) {
      this.scene.remove(before.bricks.mesh);
      before.bricks.dispose();
    }
    const playhead = new Playhead(wanted, this.origin);
    const bricks = new BrickMesh(wanted, playhead);
    bricks.surroundings.value = kMoods[this.theme].surroundings;
    this.scene.add(bricks.mesh);
    this.shown[place] = { recording: wanted, playhead, bricks };
    this.wake();
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    this.light.setMood(kMoods[theme]);
    this.table.setTheme(theme);
    for (const one of this.shown) if (one) one.bricks.surroundings.value = kMoods[theme].surroundings;
    this.wake();
  }

  /** All places have the same size. */
  resize(places: Place[], ratio: number): void {
    this.places = places;
    const [first] = places;
    const { clientWidth, clientHeight } = this.canvas;
    if (!first || first.width < 2 || first.height < 2 || clientWidth < 2) return;
    const dense = this.software ? 1 : Math.min(ratio, 2);
    this.renderer.setPixelRatio(dense);
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.live.setSize(Math.round(first.width * dense), Math.round(first.height * dense));
    this.rig.resize(first.width / first.height);
    this.wake();
  }

  wake(): void {
    if (this.asked) return;
    this.last = performance.now();
    this.asked = requestAnimationFrame((now) => this.tick(now));
  }

  private tick(now: number): void {
    this.asked = 0;
    if (this.rig.advance(Math.min(0.25, Math.max(0, (now - this.last) / 1000)), null)) this.wake();
    this.draw();
  }

  private draw(): void {
    const { camera, controls, distance } = this.rig;
    const height = this.renderer.getSize(new Vector2()).y;
    camera.updateMatrixWorld();
    const extent = this.bounds.high.distanceTo(this.bounds.low);
    this.table.showGrid(false, this.origin);
    this.table.fit(controls.target.x, controls.target.y, distance, Math.min(extent, 4 * distance));
    this.light.fit(camera, this.bounds, this.brickHeight);
    this.renderer.setRenderTarget(null);
    this.renderer.setScissorTest(false);
    this.renderer.setClearColor(0, 0);
    this.renderer.clear();
    this.places.forEach((place, i) => {
      const one = this.shown[i];
      if (!one) return;
      if (one.playhead.time !== this.time) {
        one.playhead.moveTo(this.time);
        one.bricks.update();
      }
      for (const other of this.shown) if (other) other.bricks.mesh.visible = other === one;
      this.renderer.shadowMap.needsUpdate = true;
      this.renderer.setRenderTarget(this.live);
      this.renderer.clear();
      this.renderer.render(this.scene, camera);
      const box = [place.x, height - place.y - place.height, place.width, place.height] as const;
      this.renderer.setViewport(...box);
      this.renderer.setScissor(...box);
      this.renderer.setScissorTest(true);
      this.pass.show(this.live.texture, this.live.texture, 0, kExposure);
      this.renderer.setScissorTest(false);
    });
  }

  dispose(): void {
    cancelAnimationFrame(this.asked);
    this.asked = -1;
    this.rig.dispose();
    for (const one of this.shown) one?.bricks.dispose();
    this.live.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }
}
