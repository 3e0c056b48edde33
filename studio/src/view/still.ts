/**
 * The still: when nothing moves, many plain frames are averaged, each with the camera shifted by part of a pixel and over a small
 * lens, the sun over its breadth and the sky over its directions. What comes out has smooth edges, soft shadows, ambient occlusion
 * and depth of field, with the same code as the live view.
 */

import { FloatType, HalfFloatType, LinearFilter, NearestFilter, PerspectiveCamera, Vector3, WebGLRenderTarget, type WebGLRenderer } from 'three';
import type { FinalPass } from './final_pass.ts';

/** Inverse powers of the root of x^9 = x + 1: an even spread of points over eight dimensions (Roberts' R sequence). */
const kRoot = 1.0850702454914507;
const kSpread = [1, 2, 3, 4, 5, 6, 7, 8].map((power) => kRoot ** -power);

/** The i-th of points spread evenly over the unit cube of eight dimensions: lens 0 and 1, pixel 2 and 3, sky 4 and 5, sun 6 and 7. */
export function spreadPoint(i: number): number[] {
  return kSpread.map((step) => (0.5 + (i + 1) * step) % 1);
}

/** Radius of the lens as a part of the distance to what is looked at. */
const kLens = 0.0032;

export class Still {
  done = 0;
  private readonly frame: WebGLRenderTarget;
  private sum: WebGLRenderTarget;
  private next: WebGLRenderTarget;
  private fence: WebGLSync | null = null;

  constructor(
    private readonly renderer: WebGLRenderer,
    private readonly pass: FinalPass,
  ) {
    const precise = renderer.extensions.has('EXT_color_buffer_float');
    const sums = { type: precise ? FloatType : HalfFloatType, depthBuffer: false, minFilter: NearestFilter, magFilter: NearestFilter };
    this.frame = new WebGLRenderTarget(1, 1, { type: HalfFloatType, minFilter: LinearFilter, magFilter: LinearFilter });
    this.sum = new WebGLRenderTarget(1, 1, sums);
    this.next = new WebGLRenderTarget(1, 1, sums);
  }

  get texture() {
    return this.sum.texture;
  }

  resize(width: number, height: number): void {
    for (const target of [this.frame, this.sum, this.next]) target.setSize(width, height);
    this.restart();
  }

  restart(): void {
    this.done = 0;
  }

  /** Whether the graphics card has finished the last frame: a slow one must not be given more than it can do. */
  get ready(): boolean {
    if (!this.fence) return true;
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    const state = gl.clientWaitSync(this.fence, 0, 0);
    if (state === gl.TIMEOUT_EXPIRED) return false;
    gl.deleteSync(this.fence);
    this.fence = null;
    return true;
  }

  /**
   * Adds one frame.
   * @param focus What is looked at: it stays sharp.
   * @param lens 1: as usual, 0: no depth of field.
   * @param render Draws the scene into the current target, lit for the given point of the spread.
   */
  add(camera: PerspectiveCamera, focus: Vector3, lens: number, render: (spread: number[]) => void): void {
    const spread = spreadPoint(this.done);
    const shifted = shiftCamera(camera, focus, lens, spread, this.frame.width, this.frame.height);
    this.renderer.setRenderTarget(this.frame);
    render(spread);
    shifted();
    this.pass.blend(this.sum.texture, this.frame.texture, 1 / (this.done + 1), this.next);
    [this.sum, this.next] = [this.next, this.sum];
    this.done++;
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    if (!this.fence) this.fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
  }

  dispose(): void {
    for (const target of [this.frame, this.sum, this.next]) target.dispose();
  }
}

/** @returns How to put the camera back. */
function shiftCamera(
  camera: PerspectiveCamera, focus: Vector3, lens: number, spread: number[], width: number, height: number,
): () => void {
  const position = camera.position.clone();
  const turn = camera.quaternion.clone();
  const distance = position.distanceTo(focus);
  const radius = lens * kLens * distance * Math.sqrt(spread[0]);
  const angle = 2 * Math.PI * spread[1];
  const right = new Vector3(1, 0, 0).applyQuaternion(turn);
  const up = new Vector3(0, 1, 0).applyQuaternion(turn);
  camera.position.addScaledVector(right, radius * Math.cos(angle)).addScaledVector(up, radius * Math.sin(angle));
  camera.up.copy(up);
  const sharp = position.clone().addScaledVector(new Vector3(0, 0, -1).applyQuaternion(turn), distance);
  camera.lookAt(sharp);
  camera.up.set(0, 0, 1);
  camera.setViewOffset(width, height, spread[2] - 0.5, spread[3] - 0.5, width, height);
  camera.updateMatrixWorld();
  return () => {
    camera.clearViewOffset();
    camera.position.copy(position);
    camera.quaternion.copy(turn);
    camera.updateMatrixWorld();
  };
}
