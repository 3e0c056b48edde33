/**
 * All bricks' poses at the playhead. Going from one time to another touches only the bricks that moved in between: those whose
 * track is under way, begins or ends there. So a frame costs as many bricks as move, and a long jump costs each track once.
 */

import { poseAt } from './motion.ts';
import { newPose } from './pose.ts';
import type { Recording } from './types.ts';

export class Playhead {
  /** Centres of mass, x y z of each brick [m], less `origin`. */
  readonly position: Float32Array;
  /** Orientations, x y z w of each brick. */
  readonly turn: Float32Array;
  /** Bricks that the last move touched: the first `touchedCount` of `touched`, each once. */
  readonly touched: Uint32Array;
  touchedCount = 0;
  /** [s] */
  time = 0;

  private readonly byStart: Uint32Array;
  private readonly byEnd: Uint32Array;
  /** How many tracks have begun, and how many are over. */
  private begun = 0;
  private over = 0;
  /** Tracks under way: begun and not over. */
  private readonly active: Uint32Array;
  private readonly slot: Int32Array;
  private activeCount = 0;
  private readonly stamp: Uint32Array;
  private moves = 0;
  private readonly pose = newPose();

  /**
   * @param origin A point near the bricks, so that 32-bit positions stay exact far from the layout's own origin [m].
   * @param before Of the same bricks: its arrays are used on, as a longer recording of one run comes.
   */
  constructor(
    readonly recording: Recording,
    readonly origin: readonly [number, number, number] = [0, 0, 0],
    before?: Playhead,
  ) {
    const { bricks, tracks } = recording;
    this.position = before?.position ?? new Float32Array(bricks.count * 3);
    this.turn = before?.turn ?? new Float32Array(bricks.count * 4);
    this.touched = new Uint32Array(bricks.count);
    this.stamp = new Uint32Array(bricks.count);
    this.active = new Uint32Array(tracks.count);
    this.slot = new Int32Array(tracks.count).fill(-1);
    this.byStart = ordered(tracks.start);
    this.byEnd = ordered(tracks.end);
    this.time = -1;
    for (let brick = 0; brick < bricks.count; brick++) this.place(brick);
    this.moveTo(0);
  }

  /** How many bricks move at the playhead (a brick with two tracks at once counts twice). */
  get movingCount(): number {
    return this.activeCount;
  }

  /** Puts every brick where it is at `time` [s]. */
  moveTo(time: number): void {
    this.touchedCount = 0;
    this.moves++;
    const { start, end } = this.recording.tracks;
    this.time = time;
    for (let i = 0; i < this.activeCount; i++) this.touch(this.active[i]);
    while (this.begun < start.length && start[this.byStart[this.begun]] <= time) this.enter(this.byStart[this.begun++]);
    while (this.over < end.length && end[this.byEnd[this.over]] <= time) this.leave(this.byEnd[this.over++]);
    while (this.over > 0 && end[this.byEnd[this.over - 1]] > time) this.enter(this.byEnd[--this.over]);
    while (this.begun > 0 && start[this.byStart[this.begun - 1]] > time) this.leave(this.byStart[--this.begun]);
    for (let i = 0; i < this.touchedCount; i++) this.place(this.touched[i]);
  }

  private enter(track: number): void {
    this.touch(track);
    if (this.slot[track] >= 0) return;
    this.slot[track] = this.activeCount;
    this.active[this.activeCount++] = track;
  }

  /** What leaves was under way, so that it has been touched already. */
  private leave(track: number): void {
    const slot = this.slot[track];
    if (slot < 0) return;
    const last = this.active[--this.activeCount];
    this.active[slot] = last;
    this.slot[last] = slot;
    this.slot[track] = -1;
  }

  private touch(track: number): void {
    const brick = this.recording.tracks.brick[track];
    if (this.stamp[brick] === this.moves) return;
    this.stamp[brick] = this.moves;
    this.touched[this.touchedCount++] = brick;
  }

  private place(brick: number): void {
    const { pose, position, turn, origin } = this;
    poseAt(this.recording, brick, this.time, pose);
    position[3 * brick] = pose.x - origin[0];
    position[3 * brick + 1] = pose.y - origin[1];
    position[3 * brick + 2] = pose.z - origin[2];
    turn[4 * brick] = pose.qx;
    turn[4 * brick + 1] = pose.qy;
    turn[4 * brick + 2] = pose.qz;
    turn[4 * brick + 3] = pose.qw;
  }
}

/** Indices in ascending order of their keys. */
function ordered(keys: Float64Array): Uint32Array {
  const indices = new Uint32Array(keys.length);
  for (let i = 0; i < keys.length; i++) indices[i] = i;
  let sorted = true;
  for (let i = 1; i < keys.length && sorted; i++) sorted = keys[i - 1] <= keys[i];
  return sorted ? indices : indices.sort((a, b) => keys[a] - keys[b]);
}
