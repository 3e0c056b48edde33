/** The pieces that come many times, put together into whole arrays. */

import type { Payload } from './payload.ts';
import type { Scene } from './small_pieces.ts';
import { kFreeStride, kNoBrick, type Bricks, type Events, type FreeKnots, type HingedKnots, type Tracks } from './types.ts';

type Numbers = Float64Array | Float32Array | Uint32Array | Uint16Array | Uint8Array;

/** One array out of many, of the type of `made`. */
function join<T extends Numbers>(parts: readonly T[], made: T): T {
  let at = 0;
  for (const part of parts) {
    made.set(part as never, at);
    at += part.length;
  }
  return made;
}

const sum = (parts: readonly { length: number }[]): number => parts.reduce((n, part) => n + part.length, 0);

export class BrickCollector {
  count = 0;
  private readonly feet: Float64Array[] = [];
  private readonly headings: Float64Array[] = [];
  private readonly kinds: Uint16Array[] = [];
  private readonly colors: Uint16Array[] = [];
  private readonly stances: Uint8Array[] = [];
  /** How many bricks the scene's parts speak of, or have come [bricks]. */
  expected = 0;

  take(piece: Payload, scene: Scene): void {
    const first = piece.u32('the first brick');
    const count = piece.count('bricks', 37);
    if (first !== this.count) piece.fail(`bricks from ${first} on, where ${this.count} should follow`);
    const axes = ['x', 'y', 'z'].map((axis) => piece.f64s(count, axis));
    const heading = piece.f64s(count, 'headings');
    const kind = piece.u16s(count, 'kinds');
    const color = piece.u16s(count, 'colours');
    const stance = piece.u8s(count, 'stances');
    const foot = new Float64Array(count * 3);
    for (let i = 0; i < count; i++) {
      for (let axis = 0; axis < 3; axis++) foot[3 * i + axis] = axes[axis][i];
      const where = foot[3 * i] + foot[3 * i + 1] + foot[3 * i + 2] + heading[i];
      if (!Number.isFinite(where)) piece.fail(`brick ${first + i} has no finite place`);
      if (kind[i] >= scene.kinds.length) piece.fail(`brick ${first + i} is of kind ${kind[i]}, which is not there`);
      if (color[i] >= scene.colors.length) piece.fail(`brick ${first + i} has colour ${color[i]}, which is not there`);
      if (stance[i] > 2) piece.fail(`brick ${first + i} has stance ${stance[i]}, which is not known`);
    }
    this.feet.push(foot);
    this.headings.push(heading);
    this.kinds.push(kind);
    this.colors.push(color);
    this.stances.push(stance);
    this.count += count;
    this.expected = Math.max(this.count, ...scene.parts.map((part) => part.first + part.count));
  }

  finish(): Bricks {
    const n = this.count;
    return {
      count: n,
      foot: join(this.feet, new Float64Array(n * 3)),
      heading: join(this.headings, new Float64Array(n)),
      kind: join(this.kinds, new Uint16Array(n)),
      color: join(this.colors, new Uint16Array(n)),
      stance: join(this.stances, new Uint8Array(n)),
    };
  }
}

/** Where a number of knots is this or more, what is above it is the track of the same piece whose knots these are. */
const kKnotsOfTrack = 0x80000000;

/** Start, brick and knots of the tracks in one piece. */
interface TrackHeads {
  free: boolean;
  start: Float64Array;
  brick: Uint32Array;
  /** The first knot of each, in this piece, and how many; several tracks may share them. */
  first: Uint32Array;
  count: Uint32Array;
  /** Of all of them together. */
  knots: number;
  /** Time of the last knot of each [s]. */
  end: Float64Array;
}

export class TrackCollector {
  private readonly heads: TrackHeads[] = [];
  private readonly times: Float32Array[] = [];
  private readonly angles: Float32Array[] = [];
  private readonly rates: Float32Array[] = [];
  private readonly accelerations: Float32Array[] = [];
  private readonly freeTimes: Float32Array[] = [];
  private readonly freeStates: Float32Array[] = [];
  /** Tracks read so far; nearly the number of bricks that have moved. */
  bricksSeen = 0;

  takeHinged(piece: Payload, bricks: number): void {
    const { tracks, knots, shared, heads } = this.readHeads(piece, bricks, false, 16);
    const time = piece.f32s(knots, 'times of knots');
    const angle = piece.f32s(knots, 'angles');
    const rate = piece.f32s(knots, 'rates');
    const acceleration = piece.f32s(knots, 'accelerations');
    for (let k = 0; k < knots; k++) {
      if (!Number.isFinite(angle[k] + rate[k] + acceleration[k])) piece.fail(`knot ${k} is not finite`);
    }
    this.finishHeads(piece, heads, tracks, shared, time);
    this.times.push(time);
    this.angles.push(angle);
    this.rates.push(rate);
    this.accelerations.push(acceleration);
  }

  takeFree(piece: Payload, bricks: number): void {
    const { tracks, knots, shared, heads } = this.readHeads(piece, bricks, true, 56);
    const time = piece.f32s(knots, 'times of knots');
    const state = new Float32Array(knots * kFreeStride);
    for (let column = 0; column < kFreeStride; column++) {
      const values = piece.f32s(knots, 'states of knots');
      for (let k = 0; k < knots; k++) {
        if (!Number.isFinite(values[k])) piece.fail(`knot ${k} is not finite`);
        state[k * kFreeStride + column] = values[k];
      }
    }
    this.finishHeads(piece, heads, tracks, shared, time);
    this.freeTimes.push(time);
    this.freeStates.push(state);
  }

  private readHeads(piece: Payload, bricks: number, free: boolean, knotBytes: number) {
    const tracks = piece.u32('the number of tracks');
    const knots = piece.u32('the number of knots');
    if (tracks * 16 + knots * knotBytes > piece.left) piece.fail(`${tracks} tracks with ${knots} knots do not fit into ${piece.left} bytes`);
    const start = piece.f64s(tracks, 'starts');
    const brick = piece.u32s(tracks, 'bricks');
    const count = piece.u32s(tracks, 'numbers of knots').slice(); // the file's own bytes stay as they are
    const first = new Uint32Array(tracks);
    let told = 0;
    for (let i = 0; i < tracks; i++) {
      if (brick[i] >= bricks) piece.fail(`a track of brick ${brick[i]}, but there are ${bricks} bricks`);
      if (!Number.isFinite(start[i])) piece.fail(`the track of brick ${brick[i]} starts at no finite time`);
      if (count[i] === 0) piece.fail(`the track of brick ${brick[i]} has no knots`);
      first[i] = told;
      if (count[i] < kKnotsOfTrack) told += count[i];
    }
    if (told !== knots) piece.fail(`its tracks have ${told} knots, the piece says ${knots}`);
    const shared = count.map((n) => (n < kKnotsOfTrack ? 0 : 1));
    for (let i = 0; i < tracks; i++) {
      if (!shared[i]) continue;
      const owner = count[i] - kKnotsOfTrack;
      if (owner >= i || shared[owner]) piece.fail(`the track of brick ${brick[i]} has the knots of none before it`);
      first[i] = first[owner];
      count[i] = count[owner];
    }
    return { tracks, knots, shared, heads: { free, start, brick, first, count, knots, end: new Float64Array(tracks) } };
  }

  private finishHeads(piece: Payload, heads: TrackHeads, tracks: number, shared: Uint32Array, time: Float32Array): void {
    for (let i = 0; i < tracks; i++) {
      const first = heads.first[i];
      const end = first + heads.count[i];
      for (let knot = first; knot < end && !shared[i]; knot++) {
        const bad = !Number.isFinite(time[knot]) || time[knot] < 0 || (knot > first && time[knot] < time[knot - 1]);
        if (bad) piece.fail(`knot ${knot - first} of brick ${heads.brick[i]} runs back in time`);
      }
      heads.end[i] = heads.start[i] + time[end - 1];
    }
    this.heads.push(heads);
    this.bricksSeen += tracks;
  }

  finish(bricks: number): { tracks: Tracks; hinged: HingedKnots; free: FreeKnots } {
    const knots = sum(this.times);
    const freeKnots = sum(this.freeTimes);
    return {
      tracks: orderTracks(this.heads, bricks),
      hinged: {
        time: join(this.times, new Float32Array(knots)),
        angle: join(this.angles, new Float32Array(knots)),
        rate: join(this.rates, new Float32Array(knots)),
        acceleration: join(this.accelerations, new Float32Array(knots)),
      },
      free: {
        time: join(this.freeTimes, new Float32Array(freeKnots)),
        state: join(this.freeStates, new Float32Array(freeKnots * kFreeStride)),
      },
    };
  }
}

/** By brick (a counting sort), then by start: the tracks of one brick are few and mostly in order already. */
function orderTracks(pieces: readonly TrackHeads[], bricks: number): Tracks {
  const count = pieces.reduce((n, piece) => n + piece.brick.length, 0);
  const firstOf = new Uint32Array(bricks + 1);
  for (const piece of pieces) for (const brick of piece.brick) firstOf[brick + 1]++;
  for (let b = 0; b < bricks; b++) firstOf[b + 1] += firstOf[b];
  const made: Tracks = {
    count,
    firstOf,
    brick: new Uint32Array(count),
    start: new Float64Array(count),
    end: new Float64Array(count),
    free: new Uint8Array(count),
    firstKnot: new Uint32Array(count),
    knotCount: new Uint32Array(count),
  };
  const used = new Uint32Array(bricks);
  const nextKnot = [0, 0];
  for (const piece of pieces) {
    const sort = piece.free ? 1 : 0;
    for (let i = 0; i < piece.brick.length; i++) {
      const brick = piece.brick[i];
      const first = firstOf[brick];
      let slot = first + used[brick]++;
      for (; slot > first && made.start[slot - 1] > piece.start[i]; slot--) moveTrack(made, slot - 1, slot);
      made.brick[slot] = brick;
      made.start[slot] = piece.start[i];
      made.end[slot] = piece.end[i];
      made.free[slot] = sort;
      made.firstKnot[slot] = nextKnot[sort] + piece.first[i];
      made.knotCount[slot] = piece.count[i];
    }
    nextKnot[sort] += piece.knots;
  }
  return made;
}

function moveTrack(tracks: Tracks, from: number, to: number): void {
  for (const column of [tracks.brick, tracks.start, tracks.end, tracks.free, tracks.firstKnot, tracks.knotCount]) column[to] = column[from];
}

type EventColumns = Omit<Events, 'count'>;

export class EventCollector {
  private readonly pieces: EventColumns[] = [];

  take(piece: Payload, bricks: number): void {
    const count = piece.count('events', 37);
    piece.u32('zero');
    const time = piece.f64s(count, 'times');
    const brick = piece.u32s(count, 'bricks');
    const by = piece.u32s(count, 'bricks that struck');
    const kind = piece.u8s(count, 'sorts of event');
    const force = piece.f32s(count, 'forces');
    const impulse = piece.f32s(count, 'impulses');
    const axes = ['x', 'y', 'z'].map((axis) => piece.f32s(count, axis));
    const where = new Float32Array(count * 3);
    for (let i = 0; i < count; i++) {
      if (brick[i] >= bricks) piece.fail(`an event of brick ${brick[i]}, but there are ${bricks} bricks`);
      if (by[i] !== kNoBrick && by[i] >= bricks) piece.fail(`an event by brick ${by[i]}, but there are ${bricks} bricks`);
      if (!Number.isFinite(time[i])) piece.fail(`event ${i} is at no finite time`);
      for (let axis = 0; axis < 3; axis++) where[3 * i + axis] = axes[axis][i];
    }
    this.pieces.push({ time, brick, by, kind, force, impulse, where });
  }

  finish(): Events {
    const count = sum(this.pieces.map((piece) => piece.time));
    const column = <K extends keyof EventColumns>(key: K): EventColumns[K][] => this.pieces.map((piece) => piece[key]);
    return {
      count,
      time: join(column('time'), new Float64Array(count)),
      brick: join(column('brick'), new Uint32Array(count)),
      by: join(column('by'), new Uint32Array(count)),
      kind: join(column('kind'), new Uint8Array(count)),
      force: join(column('force'), new Float32Array(count)),
      impulse: join(column('impulse'), new Float32Array(count)),
      where: join(column('where'), new Float32Array(count * 3)),
    };
  }
}
