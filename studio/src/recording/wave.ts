/** What can be read off a recording about its wave: where the front is, how fast, and how many bricks have fallen. */

import { turnAt } from './motion.ts';
import { extentsOf, tipAngle } from './pose.ts';
import { EventKind, kNoBrick, type Recording } from './types.ts';

/** The front's way: at `time[i]` [s] brick `brick[i]` was reached, `distance[i]` along the run [m]; only bricks that carried it further. */
export interface Front {
  time: Float64Array;
  brick: Uint32Array;
  distance: Float64Array;
  /** Of the farthest brick reached [m]. */
  length: number;
}

/** Index of the last value that is not over `limit`, -1 if all are. */
export function lastNotOver(values: Float64Array, limit: number): number {
  let low = -1;
  let high = values.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (values[middle] <= limit) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** Distance of each brick along the run [m]: that of the brick which struck it first, and the way between their feet. NaN: never struck. */
export function runDistances(recording: Recording): Float64Array {
  const { bricks, events } = recording;
  const distance = new Float64Array(bricks.count).fill(NaN);
  for (let i = 0; i < events.count; i++) {
    const brick = events.brick[i];
    if (!Number.isNaN(distance[brick])) continue;
    if (events.kind[i] === EventKind.pushed) distance[brick] = 0;
    if (events.kind[i] !== EventKind.struck || events.by[i] === kNoBrick) continue;
    const by = events.by[i];
    const step = Math.hypot(
      bricks.foot[3 * brick] - bricks.foot[3 * by],
      bricks.foot[3 * brick + 1] - bricks.foot[3 * by + 1],
    );
    distance[brick] = (Number.isNaN(distance[by]) ? 0 : distance[by]) + step;
  }
  return distance;
}

/** The front moves on whenever a brick that lies farther along the run passes 10 degrees (an `arrived` event). */
export function findFront(recording: Recording): Front {
  const { events } = recording;
  const along = runDistances(recording);
  const time: number[] = [];
  const brick: number[] = [];
  const distance: number[] = [];
  let farthest = -1;
  for (let i = 0; i < events.count; i++) {
    if (events.kind[i] !== EventKind.arrived) continue;
    const here = along[events.brick[i]];
    if (!(here > farthest)) continue;
    farthest = here;
    time.push(events.time[i]);
    brick.push(events.brick[i]);
    distance.push(here);
  }
  return {
    time: Float64Array.from(time),
    brick: Uint32Array.from(brick),
    distance: Float64Array.from(distance),
    length: Math.max(0, farthest),
  };
}

/** The front's place along the run [m], moved evenly between two arrivals; NaN before the first. */
export function frontDistance(front: Front, time: number): number {
  const i = lastNotOver(front.time, time);
  if (i < 0) return NaN;
  if (i + 1 >= front.time.length) return front.distance[i];
  const part = (time - front.time[i]) / (front.time[i + 1] - front.time[i]);
  return front.distance[i] + part * (front.distance[i + 1] - front.distance[i]);
}

/** Arrivals on either side over which a speed is taken. */
const kSpeedWindow = 2;

/** Speed of the front near its i-th arrival [m/s]; NaN where there are too few arrivals. */
export function speedAt(front: Front, i: number): number {
  const a = Math.max(0, i - kSpeedWindow);
  const b = Math.min(front.time.length - 1, i + kSpeedWindow);
  const spent = front.time[b] - front.time[a];
  return b > a && spent > 0 ? (front.distance[b] - front.distance[a]) / spent : NaN;
}

/** Speed of the front now [m/s]; NaN when there is none: before the first arrival and after the last. */
export function frontSpeed(front: Front, time: number): number {
  const last = front.time.length - 1;
  if (last < 1 || time < front.time[0] || time > front.time[last]) return NaN;
  return speedAt(front, lastNotOver(front.time, time));
}

/** When each brick that ends past its tip angle passed it for good, in order [s]: its length is how many fall in all. */
export function findFalls(recording: Recording): Float64Array {
  const { bricks, tracks } = recording;
  const falls: number[] = [];
  const turn = { angle: 0, rate: 0, acceleration: 0 };
  for (let brick = 0; brick < bricks.count; brick++) {
    const first = tracks.firstOf[brick];
    const last = tracks.firstOf[brick + 1] - 1;
    if (last < first) continue;
    const tip = tipAngle(extentsOf(recording, brick));
    const past = (time: number): boolean => {
      turnAt(recording, brick, time, turn);
      return Math.abs(turn.angle) > tip;
    };
    if (past(tracks.end[last])) falls.push(lastPassing(recording, first, last, past));
  }
  return Float64Array.from(falls).sort();
}

/** Walks back over a brick's knots to the last that is not past, then halves the way to the next. */
function lastPassing(recording: Recording, first: number, last: number, past: (time: number) => boolean): number {
  const { tracks } = recording;
  let late = tracks.end[last];
  for (let track = last; track >= first; track--) {
    const times = tracks.free[track] ? recording.free.time : recording.hinged.time;
    for (let k = tracks.knotCount[track] - 1; k >= 0; k--) {
      const early = tracks.start[track] + times[tracks.firstKnot[track] + k];
      if (past(early)) {
        late = early;
        continue;
      }
      let [low, high] = [early, late];
      for (let i = 0; i < 20; i++) {
        const middle = 0.5 * (low + high);
        if (past(middle)) high = middle;
        else low = middle;
      }
      return high;
    }
  }
  return tracks.start[first];
}

/** When the wave reached its last brick [s]; the end of a run in which it reached none. */
export function lastArrival({ events, duration }: Recording): number {
  for (let i = events.count - 1; i >= 0; i--) if (events.kind[i] === EventKind.arrived) return events.time[i];
  return duration;
}

/** The brick that the wave reached last; -1: it reached none. */
export function lastReached({ events }: Recording): number {
  for (let i = events.count - 1; i >= 0; i--) if (events.kind[i] === EventKind.arrived) return events.brick[i];
  return -1;
}

/** A second after the wave reached its last brick: later only small settling goes on. */
export function usualEnd(recording: Recording): number {
  return Math.min(recording.duration, lastArrival(recording) + 1);
}
