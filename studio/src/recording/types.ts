/** What a `.topple` file holds once decoded: plain typed arrays, so that a worker can hand them over without copying. SI units, z up. */

/** What many bricks share. */
export interface Kind {
  name: string;
  /** Along its long edge [m]. */
  height: number;
  /** [m] */
  width: number;
  /** In the direction it falls when it stands [m]. */
  thickness: number;
  /** [kg] */
  mass: number;
  /** "#rrggbb" */
  color: string;
  /** Its height, width and thickness are a ball's diameter. */
  ball: boolean;
}

/** Consecutive bricks that one entry of the layout made. */
export interface Part {
  name: string;
  first: number;
  count: number;
}

export const enum PushWay {
  angularSpeed = 0,
  force = 1,
  impulse = 2,
}

export interface Push {
  brick: number;
  /** When it begins [s]. */
  at: number;
  way: PushWay;
  /** [rad/s], [N] or [N s], by its way. */
  value: number;
  /** Above the brick's foot [m]. */
  height: number;
  /** [s] */
  duration: number;
}

export const enum Stance {
  standing = 0,
  flat = 1,
  onSide = 2,
}

/** Bricks as they were put down, one entry a brick. */
export interface Bricks {
  count: number;
  /** Centre of the face it stands on: x, y, z of each [m]. */
  foot: Float64Array;
  /** The way it falls, from +x, counter-clockwise seen from above [rad]. */
  heading: Float64Array;
  kind: Uint16Array;
  color: Uint16Array;
  stance: Uint8Array;
}

/**
 * All tracks, ordered by brick and then by start. A track is hinged or free; its knots are a run of the arrays of its sort.
 * `firstOf[b]` to `firstOf[b + 1]` are the tracks of brick b.
 */
export interface Tracks {
  count: number;
  firstOf: Uint32Array;
  brick: Uint32Array;
  /** [s] */
  start: Float64Array;
  /** Time of the last knot [s]. */
  end: Float64Array;
  /** 1: free, 0: hinged. */
  free: Uint8Array;
  firstKnot: Uint32Array;
  knotCount: Uint32Array;
}

/** Knots of the hinged tracks: time since the start of its track [s], angle [rad], rate [rad/s], acceleration [rad/s²]. */
export interface HingedKnots {
  time: Float32Array;
  angle: Float32Array;
  rate: Float32Array;
  acceleration: Float32Array;
}

/** Knots of the free tracks: time [s], then 13 numbers a knot: x y z [m], qw qx qy qz, vx vy vz [m/s], wx wy wz [rad/s]. */
export interface FreeKnots {
  time: Float32Array;
  state: Float32Array;
}
export const kFreeStride = 13;

export const enum EventKind {
  pushed = 0,
  struck = 1,
  arrived = 2,
  landed = 3,
  missed = 4,
  rested = 5,
}
export const kNoBrick = 0xffffffff;

/** Events in the order of time. What a model does not have is NaN. */
export interface Events {
  count: number;
  /** [s] */
  time: Float64Array;
  brick: Uint32Array;
  by: Uint32Array;
  kind: Uint8Array;
  /** [N] */
  force: Float32Array;
  /** [N s] */
  impulse: Float32Array;
  /** Where, against the foot of the brick: x, y, z of each [m]. */
  where: Float32Array;
}

/** Energy through time [s], [J]; potential is against all bricks as put down. */
export interface Energy {
  time: Float64Array;
  kinetic: Float64Array;
  potential: Float64Array;
  pushWork: Float64Array;
}

export const enum EndReason {
  cutOff = 0,
  atRest = 1,
  timeLimit = 2,
  waveDied = 3,
  notFinite = 4,
  stopped = 5,
}

export interface RunEnd {
  reason: EndReason;
  brick: number;
  steps: number;
  /** [s] */
  time: number;
  /** 16 hexadecimal digits. */
  hash: string;
  words: string;
}

export interface Recipe {
  version: string;
  model: string;
  layoutName: string;
  layoutText: string;
  /** [s] */
  timeStep: number;
  overrides: string[];
}

export interface Recording {
  recipe: Recipe;
  title: string;
  /** [m/s²] */
  gravity: number;
  kinds: Kind[];
  /** "#rrggbb" */
  colors: string[];
  parts: Part[];
  pushes: Push[];
  bricks: Bricks;
  tracks: Tracks;
  hinged: HingedKnots;
  free: FreeKnots;
  events: Events;
  energy: Energy;
  end: RunEnd;
  /** Time of the last thing recorded [s]. */
  duration: number;
}
