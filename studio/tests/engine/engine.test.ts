/** The engine as WebAssembly in node: the same bits as the program, the same words, and small enough. */

import { existsSync, readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { brotliCompressSync } from 'node:zlib';
import { beforeAll, describe, expect, test } from 'vitest';
import { kNamed } from '../../src/draw/colors.ts';
import { kGallery } from '../../src/draw/gallery.ts';
import { Engine, LayoutError } from '../../src/engine/engine.ts';
import { ContactSteps, kFloor } from '../../src/forces/contact_steps.ts';
import { decodeRecording } from '../../src/recording/decode.ts';
import { GrowingRecording } from '../../src/recording/growing.ts';
import { findFalls } from '../../src/recording/wave.ts';
import { halfExtents, hingedPose, newPose, tiltOf } from '../../src/recording/pose.ts';

const kRoot = fileURLToPath(new URL('../../../', import.meta.url));
const kModule = `${kRoot}studio/public/engine.wasm`;
const golden = readFileSync(`${kRoot}tests/golden/hashes.txt`, 'utf8')
  .split('\n')
  .filter((line) => line && !line.startsWith('#'))
  .map((line) => line.split(' '));

let engine: Engine;
beforeAll(async () => {
  expect(existsSync(kModule), 'build_engine of tools/setup.sh makes it').toBe(true);
  engine = await Engine.load(readFileSync(kModule));
});

const row = (count: number, more = ''): string => `[[push]]\nangular_speed_rad_s = 4\n\n[[row]]\ncount = ${count}\ngap_mm = 16.5\n${more}`;

describe('the engine', () => {
  test('takes less than 500 kB once compressed', () => {
    expect(brotliCompressSync(readFileSync(kModule)).length).toBeLessThan(500_000);
  });

  test.each(golden)('%s by %s gives the golden hash', (scene, model, hash) => {
    engine.start(readFileSync(`${kRoot}scenes/${scene}`, 'utf8'), scene, [`model.name=${model}`]);
    while (engine.advance(1000));
    expect(engine.hash).toBe(hash);
  });

  test('a bad layout is refused with the program’s words, all at once', () => {
    const attempt = (): unknown => engine.read('[[row]]\ncount = 0\ngap_mm = 1\ncolour = 3\n', 'mine.toml');
    expect(attempt).toThrow(LayoutError);
    expect(attempt).toThrow(/mine\.toml:2:9: row\.0\.count: must be[\s\S]*mine\.toml:4:10: row\.0\.colour:.*did you mean|nearest|color/);
  });

  test('an image becomes a picture of the same colours as the page offers', () => {
    const pixels = new Uint8ClampedArray(kNamed.flatMap(([color]) => [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16)).concat(255)));
    const order = { pixels, width: 12, height: 1, pitch: 0.016, rowPitch: 0.016, bricks: 12, dither: false };
    const usual = engine.picture({ ...order, colors: [] });
    expect(usual).toMatchObject({ rows: 1, count: 12, used: kNamed.map(() => 1), cells: Uint8Array.from(kNamed.keys()) });
    expect(usual.text).toMatch(/picture = \[\n {2}"roygtbBvc\.s#",\n\]\n$/);
    const named = engine.picture({ ...order, colors: kNamed.map(([color]) => ({ color })) });
    expect(named).toEqual(usual);
    const short = engine.picture({ ...order, colors: [{ color: '#000000', stock: 2 }, { color: '#ffffff' }] });
    expect(short.used).toEqual([2, 10]);
    expect(() => engine.picture({ ...order, colors: [{ color: '#000000', stock: 2 }] })).toThrow(/10 are missing/);
  });

  test('bricks put down by hand: engines that share the runs come to what the program says', async () => {
    const text = readFileSync(`${kRoot}scenes/by_hand.toml`, 'utf8');
    const engines = [engine, await Engine.load(readFileSync(kModule))];
    for (const one of engines) one.riskBegin(text, 'by_hand.toml', ['model.name=rigid'], 0.0005, (1.7 / 180) * Math.PI);
    // `topple risk scenes/by_hand.toml --runs 20`
    for (let seed = 20; seed >= 1; seed--) engine.riskAdd(engines[seed % 2].riskRun(seed));
    engine.riskAdd(engines[1].riskRun(3)); // again: it counts once
    const found = engine.risk();
    expect(found).toMatchObject({ runs: 20, notBuilt: 0, links: 73, exactlyStanding: 0, whole: { count: 12, of: 20 } });
    expect(found.weak).toMatchObject([{ brick: 39, stops: { count: 8, of: 20 } }]);
    expect(found.weak[0].stops.low).toBeCloseTo(0.2188, 4);
    expect(found.weak[0].stops.high).toBeCloseTo(0.6134, 4);
    expect(found.parts[0]).toMatchObject({ name: 'row 3', stops: { count: 8, of: 20 } });
    expect(found.arrival).toBeCloseTo(2.18187, 5);
    expect(found.spread).toBeCloseTo(0.0602, 4);
    expect(() => engine.riskBegin('[[row]]\ncount = 3\ngap_mm = 10\n', 'mine.toml', [], 0.0005, 0)).toThrow(/mine\.toml: no brick of a line falls/);
  });

  test('overlapping bricks can be drawn, are told, and cannot be run', () => {
    const text = `${row(3)}\n[[brick]]\nat_mm = [24, 1]\n`;
    const draft = engine.read(text);
    expect(draft.bricks).toBe(4);
    expect(draft.doubts[0]).toMatchObject({ kind: 'overlap', brick: 3, other: 1 });
    expect(() => engine.start(text)).toThrow(/overlap/);
  });

  test('the forces of a falling row: the floor presses upwards, bricks forwards, as much as the motion needs', () => {
    engine.watch(row(6), 'row.toml', ['model.name=rigid']);
    const steps = new ContactSteps(engine.watchSteps(12).bytes);
    expect(steps.times.length).toBe(12);
    // Before it strikes the next one the first brick alone presses on the floor, near its toe, 3.75 mm ahead of its foot.
    const [one] = steps.at(11);
    expect(steps.at(11).every(({ brick, by }) => brick === 0 && by === kFloor)).toBe(true);
    expect(one.point[0]).toBeCloseTo(0.00375, 4);
    expect(one.force[2]).toBeGreaterThan(0);
    // The hinge hands on what its motion says: some brick presses on the one ahead of it.
    engine.watch(row(6), 'row.toml', ['model.name=hinge']);
    const later = new ContactSteps(engine.watchSteps(20).bytes).at(19);
    const pairs = later.filter(({ by }) => by !== kFloor);
    expect(pairs.length).toBeGreaterThan(0);
    for (const { brick, by, force } of pairs) {
      expect(brick).toBe(by + 1);
      expect(force[0]).toBeGreaterThan(0);
    }
    // A run that goes on beside it is not disturbed.
    expect(() => engine.watch('[[row]]\ncount = 0\n')).toThrow(LayoutError);
  });

  test('a stop ends a run cleanly where it is', () => {
    const growing = new GrowingRecording();
    growing.add(engine.start(row(50), 'row.toml', ['model.name=hinge']));
    engine.advance(20);
    growing.add(engine.collect(false));
    const early = growing.look(false);
    engine.stop();
    growing.add(engine.collect(true));
    const recording = growing.look(true);
    expect(recording.end.words).toBe('the run was stopped');
    expect(recording.end.steps).toBe(20);
    expect(early.duration).toBeLessThanOrEqual(recording.duration);
  });

  // Flat and on their sides: where the page puts a brick is where the engine's free motion begins, so that nothing turns over when it wakes.
  test.each(['standing', 'flat', 'on_side'])('a %s brick is drawn as the engine put it down', (pose) => {
    const text = `[[push]]\nimpulse_n_s = 0.0005\nheight_mm = 5\n\n[[brick]]\nat_mm = [10, 20]\nheading_deg = 30\npose = "${pose}"\n`;
    engine.start(text, 'one.toml', ['model.name=rigid']);
    const growing = new GrowingRecording();
    growing.add(engine.collect(false));
    const start = engine.start(text, 'one.toml', ['model.name=rigid']);
    engine.advance(400);
    engine.stop();
    const all = new GrowingRecording();
    all.add(start);
    all.add(engine.collect(true));
    const recording = all.look(true);
    expect(recording.tracks.free[0]).toBe(1);
    const put = newPose();
    hingedPose(recording, 0, 0, put);
    const [qw, qx, qy, qz] = recording.free.state.subarray(3, 7);
    const same = Math.abs(qw * put.qw + qx * put.qx + qy * put.qy + qz * put.qz);
    expect(same).toBeCloseTo(1, 6);
    expect(tiltOf(recording, 0, put)).toBeLessThan(1e-6);
    expect(halfExtents(recording, 0)).toEqual([0.00375, 0.012, 0.024]);
  });
});

describe('doubts', () => {
  const words = (text: string): string[] => engine.read(text).doubts.map((doubt) => doubt.words);

  test('a straight row has none', () => expect(words(row(10))).toEqual([]));
  test('without a push nothing falls', () => expect(words('[[row]]\ncount = 3\ngap_mm = 10\n')).toEqual(['Nothing is pushed: no brick will fall.']));

  test('a gap that is too wide is told with the friction', () => {
    // With friction 0.2 a brick is tipped only when hit over 7.5 / 0.4 = 18.75 mm; from 48 mm of brick that is sqrt(48^2 - 18.75^2) = 44.2 mm away.
    const at = (gap: number): string => row(3, '').replace('16.5', String(gap)) + '\n[contact]\nfloor_friction = 0.2\n';
    expect(words(at(44))).toEqual([]);
    expect(words(at(45))[0]).toBe('Gap 45 mm between bricks 0 and 1 is likely beyond reach with floor friction 0.2.');
  });

  test('a brick beside the fall is told by how much', () => {
    const text = `${row(3)}\n[[brick]]\nat_mm = [72, 27]\n`;
    expect(words(text)).toEqual(['Brick 2 misses 3 by 3 mm.']); // 27 mm to the side of two bricks 24 mm wide
  });
});

test('what the engine reads is what the decoder reads', () => {
  const draft = engine.read(row(7, 'color = "#123456"\n'), 'seven.toml');
  const recording = decodeRecording(draft.scene);
  expect(recording.bricks.count).toBe(7);
  expect(recording.colors).toEqual(['#123456']);
  expect(recording.tracks.count).toBe(0);
  expect(draft.length).toBeCloseTo(6 * 0.024, 12);
});

test.each(kGallery)('the gallery: $name has no doubts and all of it falls, but where it is meant to stop', ({ name, text }) => {
  const doubts = engine.read(text).doubts.map((doubt) => doubt.kind);
  expect(doubts).toEqual(name === 'Where it stops' ? ['beyond_reach'] : []);
  const growing = new GrowingRecording();
  growing.add(engine.start(text));
  while (engine.advance(1000));
  growing.add(engine.collect(true));
  const recording = growing.look(true);
  // Where the gap is too wide the ten bricks before it fall.
  expect(findFalls(recording).length).toBe(name === 'Where it stops' ? 10 : recording.bricks.count);
});
