import { describe, expect, test } from 'vitest';
import { decodeRecording } from '../../src/recording/decode.ts';
import { cubic, turnBetweenKnots } from '../../src/recording/hermite.ts';
import { poseAt, turnAt } from '../../src/recording/motion.ts';
import { Playhead } from '../../src/recording/playhead.ts';
import { hingedPose, newPose, tiltOf } from '../../src/recording/pose.ts';
import { findFalls, findFront, frontSpeed } from '../../src/recording/wave.ts';
import { curvesOf, doingAt, EventIndex } from '../../src/recording/story.ts';
import { kHitStep, leaning, makeRecording, tiltsAt } from '../make_recording.ts';

const recording = decodeRecording(makeRecording({ count: 30 }));

describe('interpolation', () => {
  test('the angle gives back any polynomial of the fifth degree, the rate one of the third, the acceleration a line', () => {
    const p = (t: number): number => 0.3 - t + 2 * t ** 2 + t ** 3 - 3 * t ** 4 + 0.7 * t ** 5;
    const v = (t: number): number => -1 + 4 * t + 3 * t ** 2 - 12 * t ** 3 + 3.5 * t ** 4;
    const a = (t: number): number => 4 + 6 * t - 36 * t ** 2 + 14 * t ** 3;
    const [t0, t1] = [0.2, 0.9];
    const out = { angle: 0, rate: 0, acceleration: 0 };
    for (const s of [0, 0.1, 0.5, 0.77, 1]) {
      turnBetweenKnots(s, t1 - t0, p(t0), v(t0), a(t0), p(t1), v(t1), a(t1), out);
      expect(out.angle).toBeCloseTo(p(t0 + s * (t1 - t0)), 12);
      expect(out.acceleration).toBeCloseTo(a(t0) + s * (a(t1) - a(t0)), 12);
    }
    // A rate of the second degree, whose slopes at the ends are the accelerations there.
    turnBetweenKnots(0.25, 2, 0, 1, 0, 0, 5, 4, out);
    expect(out.rate).toBeCloseTo(1 + 0.5 ** 2, 12);
  });

  test('the cubic gives back any polynomial of the third degree', () => {
    const p = (t: number): number => 1 + 2 * t - t ** 2 + 4 * t ** 3;
    const v = (t: number): number => 2 - 2 * t + 12 * t ** 2;
    for (const s of [0, 0.3, 1]) expect(cubic(s, 0.5, p(1), v(1), p(1.5), v(1.5))).toBeCloseTo(p(1 + s * 0.5), 12);
  });

  test('a brick turned about its toe keeps the toe where it was, one turned back its heel', () => {
    const pose = newPose();
    for (const angle of [0, 0.4, Math.PI / 2, -0.3]) {
      hingedPose(recording, 3, angle, pose);
      // The toe (or heel) in the brick's own axes, rotated about +y by the angle: x' = x cos + z sin, z' = -x sin + z cos.
      const x = angle >= 0 ? 0.00375 : -0.00375;
      const [c, s] = [Math.cos(angle), Math.sin(angle)];
      expect(pose.x + x * c - 0.024 * s).toBeCloseTo(3 * 0.024 + x, 12);
      expect(pose.z - x * s - 0.024 * c).toBeCloseTo(0, 12);
      expect(tiltOf(recording, 3, pose)).toBeCloseTo(Math.abs(angle), 7);
    }
  });

  test('at the end every brick leans on the next, the last lies flat', () => {
    const turn = { angle: 0, rate: 0, acceleration: 0 };
    let front = Math.PI / 2;
    turnAt(recording, 29, 99, turn);
    expect(turn.angle).toBeCloseTo(front, 6);
    for (let brick = 28; brick >= 0; brick--) {
      front = leaning(front, 0.024);
      turnAt(recording, brick, 99, turn);
      expect(turn.angle).toBeCloseTo(front, 6);
      expect(turn.rate).toBe(0);
    }
  });

  test('between knots the made-up motion is met within a hundredth of a degree', () => {
    const turn = { angle: 0, rate: 0, acceleration: 0 };
    const time = 20.6 * kHitStep;
    const tilts = tiltsAt(30, 0.024, time);
    turnAt(recording, 20, time, turn);
    expect(Math.abs(turn.angle - tilts[20])).toBeLessThan(2e-4);
  });
});

describe('the playhead', () => {
  test('gives the same poses by any way to a time as the tracks themselves', () => {
    const head = new Playhead(recording);
    const pose = newPose();
    for (const time of [0.1, 0.3, 0.2, recording.duration, 0.45, 0.4501, 0, -1, 99, 0.0254, 0.5]) {
      head.moveTo(time);
      for (let brick = 0; brick < 30; brick++) {
        poseAt(recording, brick, time, pose);
        expect(head.position[3 * brick]).toBe(Math.fround(pose.x));
        expect(head.turn[4 * brick + 1]).toBe(Math.fround(pose.qy));
      }
    }
  });

  test('touches only what moves', () => {
    const head = new Playhead(recording);
    head.moveTo(5 * kHitStep + 0.001);
    head.moveTo(5 * kHitStep + 0.002);
    expect(head.touchedCount).toBeLessThanOrEqual(6);
    head.moveTo(99);
    head.moveTo(100);
    expect(head.touchedCount).toBe(0);
  });
});

describe('the wave', () => {
  test('moves at a pitch a hit and there is none before the first arrival or after the last', () => {
    const front = findFront(recording);
    expect(front.length).toBeCloseTo(29 * 0.024, 9);
    expect(frontSpeed(front, 0.4)).toBeCloseTo(0.024 / kHitStep, 6);
    expect(frontSpeed(front, 0)).toBeNaN();
    expect(frontSpeed(front, recording.duration)).toBeNaN();
  });

  test('all bricks fall, in order', () => {
    const falls = findFalls(recording);
    expect(falls.length).toBe(30);
    expect(Array.from(falls)).toEqual([...falls].sort((a, b) => a - b));
  });
});

describe('the story of a brick', () => {
  const index = new EventIndex(recording);
  test('says what it does at each time', () => {
    expect(doingAt(recording, index, 9, 0).words).toBe('standing');
    expect(doingAt(recording, index, 9, 9.5 * kHitStep).words).toBe('falling');
    expect(doingAt(recording, index, 9, 10.5 * kHitStep)).toEqual({ words: 'falling, leaning on', brick: 10 });
    expect(doingAt(recording, index, 9, 99)).toEqual({ words: 'at rest, leaning on', brick: 10 });
    expect(doingAt(recording, index, 29, 99).words).toBe('at rest on the table');
  });

  test('has curves whose rate breaks at the hit', () => {
    const curves = curvesOf(recording, 9)!;
    expect(curves.jumps[0]).toBeCloseTo(9 * kHitStep, 9);
    expect(curves.time.every((t, i) => i === 0 || t >= curves.time[i - 1])).toBe(true);
    const gap = curves.rate.indexOf(null);
    expect(curves.rate[gap - 1]).toBe(0);
    // At the hit the rate is nothing or what the hit gave, never in between.
    const atHit = curves.rate.filter((rate, i) => rate && Math.abs(curves.time[i] - 9 * kHitStep) < 1e-9) as number[];
    for (const rate of atHit) expect(rate).toBeCloseTo(Math.asin(0.0165 / 0.048) / kHitStep, 4);
    expect(curves.angle.every((a) => a !== null)).toBe(true);
  });
});
