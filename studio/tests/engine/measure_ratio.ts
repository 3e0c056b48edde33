/**
 * What the page's engine costs against the program, at lengths where starting up no longer counts: `npx vite-node tests/engine/measure_ratio.ts [turns]`,
 * in node and in Chromium.
 * Processor time of the same work, reading the layout and the run with its recording in memory (neither writes it out); the median of
 * several turns of each, one after the other, since the machine is shared; and whether the hashes are the same.
 */

import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { Engine } from '../../src/engine/engine.ts';
import { openEngineInBrowser } from './engine_in_browser.ts';

const root = new URL('../../../', import.meta.url).pathname;
const engine = await Engine.load(readFileSync(`${root}build/wasm/engine.wasm`));
const browser = await openEngineInBrowser(`${root}build/wasm/engine.wasm`);
const turns = Number(process.argv[2] ?? 7);

const median = (values: number[]): number => values.sort((a, b) => a - b)[values.length >> 1];

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
  const own: number[] = [];
  const browsers: number[] = [];
  const natives: number[] = [];
  let [hash, seen, expected, bricks] = ['', '', '', 0];
  // The first turn is the compiler's: it is not counted.
  for (let turn = -1; turn < turns; turn++) {
    const before = process.cpuUsage();
    engine.start(text, scene, overrides);
    while (engine.advance(4096));
    const cpu = process.cpuUsage(before);
    engine.collect(true);
    const there = await browser.run(text, scene, overrides);
    if (turn < 0) continue;
    browsers.push(there.cpu);
    seen = there.hash;
    own.push((cpu.user + cpu.system) / 1e6);
    hash = engine.hash;
    const words = ['run', `${root}scenes/${scene}`, '--json', ...overrides.flatMap((setting) => ['--set', setting])];
    const told = JSON.parse(execFileSync(`${root}build/release/topple`, words, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] })) as { cpu_s: number; hash: string; bricks: number };
    natives.push(told.cpu_s);
    [expected, bricks] = [told.hash, told.bricks];
  }
  const [node, page, native] = [median(own), median(browsers), median(natives)];
  console.log(
    `${model} ${scene} ${bricks.toLocaleString('en-GB')} bricks: the program ${native.toFixed(3)} s; node ${node.toFixed(3)} s, ratio ${(node / native).toFixed(2)}; ` +
      `Chromium ${page.toFixed(3)} s, ratio ${(page / native).toFixed(2)}; ` +
      (hash === expected && seen === expected ? `all ${hash}` : `hashes DIFFER: ${hash} ${seen} ${expected}`),
  );
}
await browser.close();
