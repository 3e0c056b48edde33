/** Runs every scene by the program and by the engine in node, and compares: `npx vite-node tests/engine/run_scenes.ts`. Prints CPU times too. */

import { execFileSync } from 'node:child_process';
import { readdirSync, readFileSync } from 'node:fs';
import { Engine } from '../../src/engine/engine.ts';

const root = new URL('../../../', import.meta.url).pathname;
const engine = await Engine.load(readFileSync(`${root}build/wasm/engine.wasm`));
const model = process.argv[2] ?? '';
for (const scene of readdirSync(`${root}scenes`).filter((name) => name.endsWith('.toml'))) {
  const overrides = model ? [`model.name=${model}`] : [];
  const text = readFileSync(`${root}scenes/${scene}`, 'utf8');
  const t0 = process.cpuUsage();
  let hash = '';
  try {
    engine.start(text, scene, overrides);
    while (engine.advance(4096));
    engine.collect(true);
    hash = engine.hash;
  } catch (error) {
    hash = String(error);
  }
  const cpu = process.cpuUsage(t0);
  let native: { hash: string; cpu_s: number } | null = null;
  try {
    native = JSON.parse(execFileSync(`${root}build/release/topple`, ['run', `${root}scenes/${scene}`, '--json', ...(model ? ['--model', model] : [])], { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] }));
  } catch (error) {
    console.log(scene, String(error).slice(0, 300));
  }
  const wasm = (cpu.user + cpu.system) / 1e6;
  console.log(scene, hash, native?.hash === hash ? 'same' : `DIFFERS ${native?.hash}`, `wasm ${wasm.toFixed(3)} s, native ${native?.cpu_s.toFixed(3)} s`);
}
