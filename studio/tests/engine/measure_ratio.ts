/**
 * What the page's engine costs against the program, at lengths where starting up no longer counts: `npx vite-node tests/engine/measure_ratio.ts`.
 * Processor time, the least of several turns of each, one after the other; and whether the hashes are the same.
 */

import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { Engine } from '../../src/engine/engine.ts';

const root = new URL('../../../', import.meta.url).pathname;
const engine = await Engine.load(readFileSync(`${root}build/wasm/engine.wasm`));
const turns = Number(process.argv[2] ?? 3);

const kRuns: [string, string, string[]][] = [
  ['pivot', 'report_row.toml', ['row.0.count=20000']],
  ['hinge', 'row_default.toml', ['row.0.count=100000']],
  ['hinge', 's_curve.toml', []],
  ['rigid', 'row_default.toml', ['row.0.count=5000']],
  ['rigid', 's_curve.toml', []],
  ['rigid', 'curve_u.toml', []],
];

for (const [model, scene, settings] of kRuns) {
  const overrides = [`model.name=${model}`, ...settings];
  const text = readFileSync(`${root}scenes/${scene}`, 'utf8');
  let [least, native] = [Infinity, Infinity];
  let [hash, expected, bricks] = ['', '', 0];
  for (let turn = 0; turn < turns; turn++) {
    const before = process.cpuUsage();
    engine.start(text, scene, overrides);
    while (engine.advance(4096));
    engine.collect(true);
    const cpu = process.cpuUsage(before);
    least = Math.min(least, (cpu.user + cpu.system) / 1e6);
    hash = engine.hash;
    const words = ['run', `${root}scenes/${scene}`, '--json', ...overrides.flatMap((setting) => ['--set', setting])];
    const told = JSON.parse(execFileSync(`${root}build/release/topple`, words, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] })) as { cpu_s: number; hash: string; bricks: number };
    native = Math.min(native, told.cpu_s);
    [expected, bricks] = [told.hash, told.bricks];
  }
  console.log(
    `${model} ${scene} ${bricks.toLocaleString('en-GB')} bricks: ${least.toFixed(3)} s, the program ${native.toFixed(3)} s, ratio ${(least / native).toFixed(2)}, ` +
      (hash === expected ? `both ${hash}` : `hashes DIFFER: ${hash} ${expected}`),
  );
}
