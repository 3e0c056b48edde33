/** The 3-D view: one scene, drawn live while anything moves and averaged into a still when nothing does. */

import { HalfFloatType, Mesh, Raycaster, Scene, SRGBColorSpace, type Ray, Vector2, Vector3, WebGLRenderer, WebGLRenderTarget } from 'three';
import type { Playhead } from '../recording/playhead.ts';
import { extentsOf } from '../recording/pose.ts';
import type { Recording } from '../recording/types.ts';
import { BrickMesh } from './bricks.ts';
import { FinalPass } from './final_pass.ts';
import { kMoods, Light, type Bounds } from './light.ts';
import { outlineOf, type Outline } from './outline.ts';
import { pickBrick } from './pick.ts';
import { Rig } from './rig.ts';
import { Still } from './still.ts';
import { Table } from './table.ts';

export type Theme = 'light' | 'dark';

/** Frames in a finished still, on a graphics card and drawn in software. */
const kStillFrames = { card: 128, software: 40 };
/** The ACES fit is made for a scene a little brighter than white paper. */
export const kExposure = 1 / 0.6;
/** How long nothing must move before the still begins [s]. */
const kPatience = 0.25;
/** Bricks that frame the run: more would not change the picture. */
const kFramePoints = 1500;

/** True where the page can have a 3-D view. */
export function hasWebGl(): boolean {
  try {
    return document.createElement('canvas').getContext('webgl2') !== null;
  } catch {
    return false;
  }
}

export class View {
  readonly rig: Rig;
  bricks: BrickMesh;
  /** Averaging may be switched off, for tests and by a person who saves power. */
  stills = true;
  /** Drawn by the processor: no graphics card. */
  readonly software: boolean;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly light: Light;
  private readonly table: Table;
  private readonly pass: FinalPass;
  private readonly still: Still;
  private readonly live: WebGLRenderTarget;
  private bounds: Bounds;
  private brickHeight: number;
  private ghost: Mesh | null = null;
  private theme: Theme = 'light';
  private dirty = true;
  private quiet = 0;
  private share = 0;
  private gridded = false;

  constructor(
    readonly canvas: HTMLCanvasElement,
    recording: Recording,
    private playhead: Playhead,
    /** Called when the picture will change by itself: a camera was dragged. */
    wake: () => void,
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: false, powerPreference: 'high-performance' });
    this.renderer.info.autoReset = false;
    this.software = isSoftware(this.renderer);
    this.brickHeight = tallest(recording);
    const points = framePoints(recording, playhead.origin);
    this.bounds = boundsOf(points);
    this.rig = new Rig(canvas, points, this.brickHeight, () => {
      this.dirty = true;
      wake();
    });
    this.light = new Light(this.scene, this.renderer, this.software ? 1024 : 2048);
    this.light.placeSun(this.rig.defaultForward());
    this.table = new Table(this.scene);
    this.bricks = new BrickMesh(recording, playhead);
    this.scene.add(this.bricks.mesh);
    this.pass = new FinalPass(this.renderer);
    this.still = new Still(this.renderer, this.pass);
    this.live = new WebGLRenderTarget(1, 1, { type: HalfFloatType, samples: this.software ? 0 : 4 });
    void this.makeShaders().then(wake);
  }

  /** Whether a frame can be drawn without waiting for the shaders, which a browser makes beside the page's thread if it can. */
  ready = false;

  private async makeShaders(): Promise<void> {
    const { renderer } = this;
    if (!renderer.extensions.has('KHR_parallel_shader_compile')) {
      this.ready = true;
      return;
    }
    this.light.useLive();
    const shadow = new Mesh(this.bricks.mesh.geometry, this.bricks.mesh.customDepthMaterial);
    this.scene.add(shadow);
    this.pass.compile();
    renderer.setRenderTarget(this.live); // a program is made for what it draws into
    const made = renderer.compileAsync(this.scene, this.rig.camera);
    this.scene.remove(shadow);
    await made;
    this.ready = true;
  }

  /** Other bricks take the place of those that are shown; the camera stays. */
  replace(recording: Recording, playhead: Playhead): void {
    this.scene.remove(this.bricks.mesh);
    if (this.ghost) this.scene.remove(this.ghost);
    this.ghost = null;
    this.bricks.dispose();
    this.playhead = playhead;
    this.brickHeight = tallest(recording);
    const points = framePoints(recording, playhead.origin);
    this.bounds = boundsOf(points);
    this.rig.setPoints(points, this.brickHeight);
    this.bricks = new BrickMesh(recording, playhead);
    this.bricks.surroundings.value = kMoods[this.theme].surroundings;
    this.scene.add(this.bricks.mesh);
    this.changed();
  }

  /** The same bricks with more of their motion. */
  follow(playhead: Playhead): void {
    this.playhead = playhead;
    this.bricks.follow(playhead);
    this.changed();
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    this.light.setMood(kMoods[theme]);
    this.bricks.surroundings.value = kMoods[theme].surroundings;
    this.table.setTheme(theme);
    this.changed();
  }

  /** @param width, height In CSS pixels. */
  resize(width: number, height: number, ratio: number): void {
    this.renderer.setPixelRatio(this.software ? 1 : Math.min(ratio, 2));
    this.renderer.setSize(width, height, false);
    const size = this.renderer.getDrawingBufferSize(new Vector2());
    this.live.setSize(size.x, size.y);
    this.still.resize(size.x, size.y);
    this.rig.resize(width / height);
    this.changed();
  }

  /** How high a standing brick is in the middle of the view [CSS px]. */
  get brickPixels(): number {
    return this.rig.sizeAt(this.rig.distance) * this.canvas.clientHeight;
  }

  /** Lines on the table while one draws. */
  set drawing(on: boolean) {
    this.rig.setDrawing(on);
    this.gridded = on;
    this.changed();
  }

  /** Shows or hides the bricks as they were put down. */
  showGhost(shown: boolean): void {
    if (shown && !this.ghost) this.scene.add((this.ghost = this.bricks.makeGhost()));
    if (this.ghost) this.ghost.visible = shown;
    this.changed();
  }

  /** Where the ray through a pixel meets the table, in the layout's axes [m]; null above the horizon. */
  tablePoint(x: number, y: number): Vector3 | null {
    const ray = this.rayAt(x, y);
    const way = -ray.origin.z / ray.direction.z;
    return way > 0 && Number.isFinite(way) ? ray.at(way, new Vector3()).add(new Vector3(...this.playhead.origin)) : null;
  }

  /** A place [m, in the layout's axes] in CSS pixels from the view's upper left corner, or in a picture of another size; null behind the camera. */
  pixelOf(place: Vector3, width = this.canvas.clientWidth, height = this.canvas.clientHeight): { x: number; y: number } | null {
    this.rig.camera.updateMatrixWorld();
    const at = place.clone().sub(new Vector3(...this.playhead.origin)).project(this.rig.camera);
    if (at.z > 1) return null;
    return { x: (0.5 + 0.5 * at.x) * width, y: (0.5 - 0.5 * at.y) * height };
  }

  /** Something moved: the next frame is drawn anew. */
  changed(): void {
    this.dirty = true;
  }

  get stillFrames(): number {
    return this.software ? kStillFrames.software : kStillFrames.card;
  }

  /** How much of the still is done, 0 to 1. */
  get stillPart(): number {
    return Math.min(1, this.still.done / this.stillFrames);
  }

  /**
   * Draws what there is to draw.
   * @param dt Since the last call [s].
   * @returns Whether it wants to be called again for the next frame.
   */
  draw(dt: number, front: Vector3 | null): boolean {
    if (this.rig.advance(dt, front)) this.dirty = true;
    if (this.dirty) {
      this.dirty = false;
      this.quiet = 0;
      this.share = 0;
      this.still.restart();
      this.drawLive();
      return true;
    }
    if (!this.stills || this.still.done >= this.stillFrames) return false;
    this.quiet += dt;
    if (this.quiet < kPatience || !this.still.ready) return true;
    this.addToStill();
    this.share = Math.min(1, Math.max(0, (this.still.done - 6) / 14));
    if (this.share > 0) this.show();
    return true;
  }

  private drawLive(): void {
    this.bricks.update();
    this.prepare();
    this.light.useLive();
    this.light.fit(this.rig.camera, this.bounds, this.brickHeight);
    this.renderer.shadowMap.needsUpdate = true;
    this.renderer.setRenderTarget(this.live);
    this.renderer.render(this.scene, this.rig.camera);
    this.show();
  }

  private prepare(): void {
    this.table.showGrid(this.gridded, this.playhead.origin);
    const target = this.rig.controls.target;
    const extent = this.bounds.high.distanceTo(this.bounds.low);
    this.table.fit(target.x, target.y, this.rig.distance, Math.min(extent, 4 * this.rig.distance));
    this.rig.camera.updateMatrixWorld();
  }

  private addToStill(): void {
    this.prepare();
    const lens = this.rig.way === 'top' ? 0 : 1;
    this.still.add(this.rig.camera, this.rig.controls.target, lens, (spread) => {
      const directions = this.light.useSample(spread);
      this.light.fit(this.rig.camera, this.bounds, this.brickHeight, directions);
      this.renderer.shadowMap.needsUpdate = true;
      this.renderer.render(this.scene, this.rig.camera);
    });
  }

  private show(): void {
    this.pass.show(this.live.texture, this.still.texture, this.share, kExposure);
  }

  /** Averages a whole still at once; for pictures. */
  async finishStill(frames = this.stillFrames): Promise<void> {
    if (this.dirty) this.draw(0, null);
    while (this.still.done < frames && !this.dirty) {
      if (this.still.ready) this.addToStill();
      await new Promise((resume) => setTimeout(resume, 0));
    }
    this.share = this.still.done > 0 ? 1 : 0;
    this.show();
  }

  /** The picture as it is now, a PNG. */
  picture(): Promise<Blob> {
    this.show();
    return new Promise((resolve, reject) =>
      this.canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('The browser made no picture.'))), 'image/png'),
    );
  }

  /** The bricks alone on nothing: a PNG with a transparent background. */
  async clearPicture(): Promise<Blob> {
    const size = this.renderer.getDrawingBufferSize(new Vector2());
    const target = new WebGLRenderTarget(size.x, size.y, { samples: 4, colorSpace: SRGBColorSpace });
    const { background, fog } = this.scene;
    this.scene.background = null;
    this.scene.fog = null;
    this.table.mesh.visible = false;
    this.prepare();
    this.renderer.setClearColor(0, 0);
    this.renderer.setRenderTarget(target);
    this.renderer.clear();
    this.renderer.render(this.scene, this.rig.camera);
    const pixels = new Uint8ClampedArray(size.x * size.y * 4);
    this.renderer.readRenderTargetPixels(target, 0, 0, size.x, size.y, pixels);
    Object.assign(this.scene, { background, fog });
    this.table.mesh.visible = true;
    target.dispose();
    this.changed();
    return pngOf(pixels, size.x, size.y);
  }

  /** @param x, y In CSS pixels from the view's upper left corner. @returns A brick or -1. */
  pick(x: number, y: number): number {
    return pickBrick(this.playhead, this.rayAt(x, y));
  }

  private rayAt(x: number, y: number): Ray {
    const caster = new Raycaster();
    const { clientWidth, clientHeight } = this.canvas;
    caster.setFromCamera(new Vector2((2 * x) / clientWidth - 1, 1 - (2 * y) / clientHeight), this.rig.camera);
    return caster.ray;
  }

  /** A brick's outline in the picture, in CSS pixels; null if it is out of sight. */
  outline(brick: number): Outline | null {
    this.rig.camera.updateMatrixWorld();
    return outlineOf(this.playhead, brick, this.rig.camera, this.canvas.clientWidth, this.canvas.clientHeight);
  }

  dispose(): void {
    this.rig.dispose();
    this.bricks.dispose();
    this.still.dispose();
    this.live.dispose();
    this.renderer.dispose();
  }
}

/** Premultiplied sRGB, bottom row first, as a picture: not premultiplied, top row first. */
async function pngOf(pixels: Uint8ClampedArray<ArrayBuffer>, width: number, height: number): Promise<Blob> {
  const image = new ImageData(width, height);
  for (let y = 0; y < height; y++) {
    image.data.set(pixels.subarray((height - 1 - y) * width * 4, (height - y) * width * 4), y * width * 4);
  }
  for (let i = 0; i < image.data.length; i += 4) {
    const alpha = image.data[i + 3] / 255;
    for (let c = 0; c < 3 && alpha > 0; c++) {
      image.data[i + c] = Math.min(255, image.data[i + c] / alpha);
    }
  }
  const sheet = new OffscreenCanvas(width, height);
  sheet.getContext('2d')?.putImageData(image, 0, 0);
  return sheet.convertToBlob({ type: 'image/png' });
}

/** Height of the tallest kind [m]; of a usual brick where there is none. */
export function tallest(recording: Recording): number {
  return recording.kinds.length ? Math.max(...recording.kinds.map((kind) => kind.height)) : 0.048;
}

export function isSoftware(renderer: WebGLRenderer): boolean {
  const gl = renderer.getContext();
  const names = gl.getExtension('WEBGL_debug_renderer_info');
  const name = names ? String(gl.getParameter(names.UNMASKED_RENDERER_WEBGL)) : '';
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

export function framePoints(recording: Recording, origin: readonly number[]): Vector3[] {
  const { bricks } = recording;
  const step = Math.max(1, Math.floor(bricks.count / kFramePoints));
  const points: Vector3[] = [];
  const add = (brick: number): void => {
    const [x, y, z] = [0, 1, 2].map((axis) => bricks.foot[3 * brick + axis] - origin[axis]);
    const { up, along, across } = extentsOf(recording, brick);
    const [c, s] = [Math.cos(bricks.heading[brick]), Math.sin(bricks.heading[brick])];
    // Its four edges from foot to top, and where its top comes to lie.
    for (const side of [-0.5 * across, 0.5 * across]) {
      for (const end of [-0.5 * along, 0.5 * along]) {
        const [px, py] = [x + c * end - s * side, y + s * end + c * side];
        points.push(new Vector3(px, py, z), new Vector3(px, py, z + up));
      }
      points.push(new Vector3(x + c * up - s * side, y + s * up + c * side, z));
    }
  };
  for (let brick = 0; brick < bricks.count; brick += step) add(brick);
  if (bricks.count > 0) add(bricks.count - 1);
  else for (const x of [-0.6, 0.6]) for (const y of [-0.4, 0.4]) points.push(new Vector3(x, y, 0));
  return points;
}

export function boundsOf(points: readonly Vector3[]): Bounds {
  const bounds = { low: new Vector3(Infinity, Infinity, Infinity), high: new Vector3(-Infinity, -Infinity, -Infinity) };
  for (const point of points) {
    bounds.low.min(point);
    bounds.high.max(point);
  }
  return bounds;
}
