/** All bricks as one instanced draw. A frame uploads only the runs of bricks that moved. */

import { DynamicDrawUsage, InstancedBufferAttribute, InstancedBufferGeometry, Mesh, Sphere, Vector3 } from 'three';
import { Playhead } from '../recording/playhead.ts';
import { halfExtents } from '../recording/pose.ts';
import type { Recording } from '../recording/types.ts';
import { brickGeometry, roundingFor } from './brick_geometry.ts';
import { brickDepthMaterial, brickMaterial } from './brick_material.ts';

/** Bricks between two that moved that are uploaded with them rather than starting another run. */
const kRunGap = 64;
/** Where more have moved they are not sorted but looked for in blocks. */
const kFew = 4096;
const kBlock = 512;

export class BrickMesh {
  readonly mesh: Mesh;
  /** How bright what the bricks mirror is. */
  readonly surroundings = { value: 1 };
  private readonly geometry: InstancedBufferGeometry;
  private readonly position: InstancedBufferAttribute;
  private readonly turn: InstancedBufferAttribute;
  private readonly color: InstancedBufferAttribute;
  /** All poses are sent with the next frame. */
  private whole = false;

  constructor(
    private readonly recording: Recording,
    private playhead: Playhead,
  ) {
    const count = recording.bricks.count;
    this.geometry = brickGeometry(roundingFor(count));
    this.geometry.instanceCount = count;
    this.position = new InstancedBufferAttribute(playhead.position, 3).setUsage(DynamicDrawUsage);
    this.turn = new InstancedBufferAttribute(playhead.turn, 4).setUsage(DynamicDrawUsage);
    this.color = new InstancedBufferAttribute(new Uint8Array(count * 4), 4, true);
    const half = new InstancedBufferAttribute(new Float32Array(count * 3), 3);
    for (let brick = 0; brick < count; brick++) {
      const [x, y, z] = halfExtents(recording, brick);
      half.setXYZ(brick, recording.kinds[recording.bricks.kind[brick]].ball ? -x : x, y, z); // < 0 tells the shader: a ball
    }
    this.geometry.setAttribute('iPosition', this.position);
    this.geometry.setAttribute('iTurn', this.turn);
    this.geometry.setAttribute('iHalf', half);
    this.geometry.setAttribute('iColor', this.color);
    this.geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
    this.paint();
    this.mesh = new Mesh(this.geometry, brickMaterial(this.surroundings));
    this.mesh.customDepthMaterial = brickDepthMaterial();
    this.mesh.frustumCulled = false;
    this.mesh.castShadow = true;
    this.mesh.receiveShadow = true;
  }

  /** Colours of the layout, each brick a shade off its neighbours, and a pair of pips that its number decides. */
  paint(heat: ((brick: number) => [number, number, number]) | null = null): void {
    const { bricks, colors } = this.recording;
    const rgb = colors.map((color) => [1, 3, 5].map((i) => parseInt(color.slice(i, i + 2), 16)));
    for (let brick = 0; brick < bricks.count; brick++) {
      const mixed = scatter(brick);
      const shade = 0.965 + 0.07 * (((mixed >>> 8) & 255) / 255);
      const base = heat ? heat(brick) : rgb[bricks.color[brick]];
      for (let i = 0; i < 3; i++) this.color.array[4 * brick + i] = Math.min(255, base[i] * (heat ? 1 : shade));
      this.color.array[4 * brick + 3] = (mixed >>> 16) % 49;
    }
    this.color.clearUpdateRanges();
    this.color.needsUpdate = true;
  }

  /** The bricks as they were put down, faint: where the run began, or how far a brick has come. */
  makeGhost(): Mesh {
    const start = new Playhead(this.recording, this.playhead.origin);
    start.moveTo(-1);
    const geometry = this.geometry.clone();
    geometry.instanceCount = this.geometry.instanceCount;
    for (const name of ['iHalf', 'iColor']) geometry.setAttribute(name, this.geometry.getAttribute(name));
    geometry.setAttribute('iPosition', new InstancedBufferAttribute(start.position, 3));
    geometry.setAttribute('iTurn', new InstancedBufferAttribute(start.turn, 4));
    const material = brickMaterial(this.surroundings);
    // Pushed back a little, so that a brick which still stands hides its ghost.
    Object.assign(material, { transparent: true, opacity: 0.22, depthWrite: false, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2 });
    const ghost = new Mesh(geometry, material);
    ghost.frustumCulled = false;
    return ghost;
  }

  /** A playhead over the same arrays takes the place of the one before. */
  follow(playhead: Playhead): void {
    this.playhead = playhead;
    this.whole = true;
    for (const attribute of [this.position, this.turn]) {
      attribute.clearUpdateRanges();
      attribute.needsUpdate = true;
    }
  }

  /** Tells the graphics card which bricks the playhead's last move touched. */
  update(): void {
    const { touched, touchedCount } = this.playhead;
    if (touchedCount === 0) return;
    if (this.whole) {
      this.whole = false; // no ranges: all of it
      return;
    }
    const runs = runsOf(touched.subarray(0, touchedCount), this.recording.bricks.count);
    for (const [attribute, width] of [[this.position, 3], [this.turn, 4]] as const) {
      for (const { first, last } of runs) attribute.addUpdateRange(first * width, (last - first + 1) * width);
      attribute.needsUpdate = true;
    }
  }

  dispose(): void {
    this.geometry.dispose();
  }
}

/** What is uploaded of the bricks that moved, so that a jump in a long row does not send the whole of it. @param moved In any order; it is sorted if it is short. */
export function runsOf(moved: Uint32Array, count: number): { first: number; last: number }[] {
  const runs: { first: number; last: number }[] = [];
  const add = (first: number, last: number): void => {
    const before = runs.at(-1);
    if (before && first <= before.last + kRunGap) before.last = last;
    else runs.push({ first, last });
  };
  if (moved.length < kFew) {
    for (const brick of moved.sort()) add(brick, brick);
    return runs;
  }
  const blocks = new Uint8Array(Math.ceil(count / kBlock));
  for (const brick of moved) blocks[Math.floor(brick / kBlock)] = 1;
  blocks.forEach((hit, block) => hit && add(block * kBlock, Math.min(count, (block + 1) * kBlock) - 1));
  return runs;
}

/** Spreads consecutive numbers over 32 bits, the same everywhere. */
function scatter(brick: number): number {
  let x = Math.imul(brick + 1, 0x9e3779b1);
  x = Math.imul(x ^ (x >>> 15), 0x85ebca6b);
  return (x ^ (x >>> 13)) >>> 0;
}
