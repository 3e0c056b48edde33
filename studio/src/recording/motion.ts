/** What a brick does at a moment: the recorded tracks, interpolated. Before its first track it stands, after a track it rests as that left it. */

import { cubic, turnBetweenKnots, type Turn } from './hermite.ts';
import { hingedPose, newPose, tiltOf, type Pose } from './pose.ts';
import { kFreeStride, type Recording } from './types.ts';

const kNoTrack = -1;

/** The track of a brick that began last, -1 before the first. */
export function trackAt(recording: Recording, brick: number, time: number): number {
  const { firstOf, start } = recording.tracks;
  let track = firstOf[brick + 1] - 1;
  while (track >= firstOf[brick] && start[track] > time) track--;
  return track >= firstOf[brick] ? track : kNoTrack;
}

/** Index of the last of `count` knots from `first` on that is not after `time` (since the start of the track); the first if none is. */
function knotBefore(times: Float32Array, first: number, count: number, time: number): number {
  let low = first;
  let high = first + count - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** Tilt of a hinged track [rad] and its derivatives at a time of the run [s]; after its last knot it rests. */
export function hingedTurn(recording: Recording, track: number, time: number, out: Turn): void {
  const { tracks, hinged } = recording;
  const first = tracks.firstKnot[track];
  const last = first + tracks.knotCount[track] - 1;
  const t = time - tracks.start[track];
  const k = knotBefore(hinged.time, first, tracks.knotCount[track], t);
  if (k >= last) {
    out.angle = hinged.angle[last];
    out.rate = 0;
    out.acceleration = 0;
    return;
  }
  const h = hinged.time[k + 1] - hinged.time[k];
  const s = Math.min(1, Math.max(0, (t - hinged.time[k]) / h));
  const { angle, rate, acceleration } = hinged;
  turnBetweenKnots(s, h, angle[k], rate[k], acceleration[k], angle[k + 1], rate[k + 1], acceleration[k + 1], out);
}

/** Pose of a brick on a free track at a time of the run [s]. */
function freePose(recording: Recording, track: number, time: number, out: Pose): void {
  const { tracks, free } = recording;
  const first = tracks.firstKnot[track];
  const last = first + tracks.knotCount[track] - 1;
  const t = time - tracks.start[track];
  const k = knotBefore(free.time, first, tracks.knotCount[track], t);
  const next = Math.min(k + 1, last);
  const h = free.time[next] - free.time[k];
  const s = h > 0 ? Math.min(1, Math.max(0, (t - free.time[k]) / h)) : 0;
  const a = k * kFreeStride;
  const b = next * kFreeStride;
  const f = free.state;
  hingedPose(recording, tracks.brick[track], 0, out);
  if (h > 0) {
    out.x += cubic(s, h, f[a], f[a + 7], f[b], f[b + 7]);
    out.y += cubic(s, h, f[a + 1], f[a + 8], f[b + 1], f[b + 8]);
    out.z += cubic(s, h, f[a + 2], f[a + 9], f[b + 2], f[b + 9]);
    turnBetween(f, a, b, s, h, out);
    return;
  }
  out.x += f[a];
  out.y += f[a + 1];
  out.z += f[a + 2];
  out.qw = f[a + 3];
  out.qx = f[a + 4];
  out.qy = f[a + 5];
  out.qz = f[a + 6];
}

const rateA = new Float64Array(4);
const rateB = new Float64Array(4);

/** Half of the angular velocity (world axes) times the quaternion: its derivative. */
function quaternionRate(f: Float32Array, at: number, out: Float64Array): void {
  const [w, x, y, z] = [f[at + 3], f[at + 4], f[at + 5], f[at + 6]];
  const [p, q, r] = [f[at + 10], f[at + 11], f[at + 12]];
  out[0] = 0.5 * (-p * x - q * y - r * z);
  out[1] = 0.5 * (p * w + q * z - r * y);
  out[2] = 0.5 * (q * w + r * x - p * z);
  out[3] = 0.5 * (r * w + p * y - q * x);
}

function turnBetween(f: Float32Array, a: number, b: number, s: number, h: number, out: Pose): void {
  quaternionRate(f, a, rateA);
  quaternionRate(f, b, rateB);
  const w = cubic(s, h, f[a + 3], rateA[0], f[b + 3], rateB[0]);
  const x = cubic(s, h, f[a + 4], rateA[1], f[b + 4], rateB[1]);
  const y = cubic(s, h, f[a + 5], rateA[2], f[b + 5], rateB[2]);
  const z = cubic(s, h, f[a + 6], rateA[3], f[b + 6], rateB[3]);
  const scale = 1 / Math.sqrt(w * w + x * x + y * y + z * z);
  out.qw = w * scale;
  out.qx = x * scale;
  out.qy = y * scale;
  out.qz = z * scale;
}

const turn: Turn = { angle: 0, rate: 0, acceleration: 0 };

/** Where a brick is at a time of the run [s]. */
export function poseAt(recording: Recording, brick: number, time: number, out: Pose): void {
  const track = trackAt(recording, brick, time);
  if (track === kNoTrack) return hingedPose(recording, brick, 0, out);
  if (recording.tracks.free[track]) return freePose(recording, track, time, out);
  hingedTurn(recording, track, time, turn);
  hingedPose(recording, brick, turn.angle, out);
}

const scratch = newPose();
/** For the derivatives of a free brick's tilt: small against a knot's length, large against rounding [s]. */
const kDifference = 1e-4;

/** Tilt of a brick [rad], signed for a hinged one, and its derivatives; those of a free brick by differences. */
export function turnAt(recording: Recording, brick: number, time: number, out: Turn): void {
  const track = trackAt(recording, brick, time);
  out.angle = out.rate = out.acceleration = 0;
  if (track === kNoTrack) return;
  if (!recording.tracks.free[track]) return hingedTurn(recording, track, time, out);
  const tilt = (t: number): number => {
    freePose(recording, track, t, scratch);
    return tiltOf(recording, brick, scratch);
  };
  const [before, now, after] = [tilt(time - kDifference), tilt(time), tilt(time + kDifference)];
  out.angle = now;
  out.rate = (after - before) / (2 * kDifference);
  out.acceleration = (after - 2 * now + before) / (kDifference * kDifference);
}

/** Whether a brick moves at a time: inside one of its tracks. */
export function isMoving(recording: Recording, brick: number, time: number): boolean {
  const track = trackAt(recording, brick, time);
  return track !== kNoTrack && time < recording.tracks.end[track];
}
