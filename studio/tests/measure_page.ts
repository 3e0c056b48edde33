/**
 * What the page costs at N bricks: `npx vite-node tests/measure_page.ts [drawn|undrawn] 100000 field:100000 ...`: one row, or as many rows
 * side by side as a row has bricks, all pushed at once, run by the program (a wave a row: hundreds of times as much moves). Opening, orbiting,
 * scrubbing and playing: all that the page's thread does for a frame, by the browser's tracing, how long of that it had a processor, which
 * part of the scripts are calls of WebGL; the time from frame to frame beside that of a plain InstancedMesh of the same bricks in a canvas of
 * the same size; memory. Each twice: drawn, here perhaps by the processors that the page's thread wants too, and ('undrawn') with the same
 * calls and buffers but one brick drawn of them all, so that the page's thread waits for nothing, as beside a graphics card.
 * The view is small, since here it may be drawn by the processor: then frames a second mean nothing but against each other.
 */

import { execFile } from 'node:child_process';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { promisify } from 'node:util';
import type { Browser, CDPSession, Page } from 'playwright-core';
import { build } from 'vite';
import { kHitStep, makeRecording } from './make_recording.ts';
import { counter, kTicker, watchMainThread } from './main_thread.ts';
import { kProgram, launch, serve } from './page/browser.ts';
import { repeatRecording } from './repeat_recording.ts';
import { splitScripts } from './script_split.ts';

const kSize = { width: 720, height: 460 };

/** Resident memory of the page's process and of the one that draws [MB]. */
async function memory(browser: Browser): Promise<string> {
  const session = await browser.newBrowserCDPSession();
  const { processInfo } = await session.send('SystemInfo.getProcessInfo');
  const sizes = new Map<string, number>();
  for (const { type, id } of processInfo) {
    const status = await readFile(`/proc/${id}/status`, 'utf8').catch(() => '');
    const size = Number(/VmRSS:\s+(\d+)/.exec(status)?.[1] ?? 0) / 1024;
    sizes.set(type, Math.max(sizes.get(type) ?? 0, size));
  }
  return `${Math.round(sizes.get('renderer') ?? 0)} MB the page, ${Math.round(sizes.get('GPU') ?? sizes.get('gpu-process') ?? 0)} MB drawing`;
}

const at = (values: number[], part: number): string => (values.sort((a, b) => a - b)[Math.floor(part * (values.length - 1))] ?? NaN).toFixed(1);

interface Phase {
  browser: Browser;
  page: Page;
  session: CDPSession;
  frames: number;
}

/** Does something for so many frames, twice: watched by the tracing, then by the profiler, which costs time itself. @returns Lines of figures. */
async function measured({ browser, page, session, frames }: Phase, name: string, step: (i: number) => Promise<unknown>): Promise<string> {
  const counts = (): Promise<{ draws: number; bytes: number }> => page.evaluate(() => ({ ...(window as never as { glCounts: { draws: number; bytes: number } }).glCounts }));
  const before = await counts();
  const watched = await watchMainThread(browser);
  for (let i = 0; i < frames; i++) await step(i);
  const drawn = (await watched()).frames.filter(({ drew }) => drew);
  const after = await counts();
  const split = await splitScripts(page, session);
  for (let i = 0; i < frames; i++) await step(frames + i);
  const { own, calls, dearest } = await split();
  const [busy, cpu] = [drawn.map((one) => one.busy), drawn.map((one) => one.cpu)];
  const [draws, bytes] = [after.draws - before.draws, after.bytes - before.bytes];
  const parts = dearest.map(([word, took]) => `${word} ${((100 * took) / calls).toFixed(0)} %`).join(', ');
  return (
    `  ${name.padEnd(10)} the page's thread a frame: median ${at(busy, 0.5)} ms, 95 % ${at(busy, 0.95)} ms; its processor time ${at(cpu, 0.5)}, ${at(cpu, 0.95)} ms (${drawn.length} frames)\n` +
    `             ${(draws / drawn.length).toFixed(1)} draws of bricks, ${(bytes / 1000 / drawn.length).toFixed(1)} kB uploaded a frame; calls of WebGL ${((100 * calls) / (own + calls)).toFixed(0)} % of the scripts (${parts})`
  );
}

async function plain(browser: Browser, size: { width: number; height: number }, feet: number[], headings: number[], frames: number): Promise<string> {
  const folder = await mkdtemp(join(tmpdir(), 'topple-plain-'));
  const entry = new URL('./plain_instances.ts', import.meta.url).pathname;
  await build({ configFile: false, logLevel: 'silent', build: { outDir: folder, lib: { entry, formats: ['es'], fileName: 'plain' }, emptyOutDir: true } });
  const script = await readFile(join(folder, 'plain.js'), 'utf8').catch(() => readFile(join(folder, 'plain.mjs'), 'utf8'));
  const server = createServer((request, response) =>
    request.url === '/plain.js'
      ? response.writeHead(200, { 'content-type': 'text/javascript' }).end(script)
      : response.writeHead(200, { 'content-type': 'text/html' }).end('<!doctype html><body style="margin:0"><script type="module" src="plain.js"></script>'));
  await new Promise<void>((ready) => server.listen(0, '127.0.0.1', ready));
  const address = server.address();
  const page = await browser.newPage({ viewport: size });
  await page.goto(`http://127.0.0.1:${typeof address === 'object' && address ? address.port : 0}/`);
  await page.waitForFunction(() => window.plain !== undefined);
  const told = await page.evaluate(([a, b, n]) => window.plain.frames(Float64Array.from(a as number[]), Float64Array.from(b as number[]), n as number), [feet, headings, frames] as const);
  await page.close();
  server.close();
  await rm(folder, { recursive: true });
  return `  plain      InstancedMesh of the same bricks: ${told.frame.toFixed(0)} ms from frame to frame, ${told.cost.toFixed(2)} ms of script in one`;
}

/** Rows side by side, pushed at once. */
async function fieldOf(count: number): Promise<Uint8Array> {
  const folder = await mkdtemp(join(tmpdir(), 'topple-field-'));
  const rows = Math.round(Math.sqrt(count));
  const [layout, recording] = [join(folder, 'field.toml'), join(folder, 'field.topple')];
  const text = `[[field]]\nrows = ${rows}\nrow_pitch_mm = 60\ncount = ${Math.round(count / rows)}\ngap_mm = 16.5\nstarter = "pushes"\nangular_speed_rad_s = 8\ncolor = "#1478c8"\ncolor_to = "#f2b928"\n\n[model]\nname = "hinge"\n`;
  await writeFile(layout, text);
  await promisify(execFile)(kProgram, ['run', layout, '--out', recording]);
  const bytes = new Uint8Array(await readFile(recording));
  await rm(folder, { recursive: true });
  return bytes;
}

/** Opens, orbits, scrubs and plays. @param drawn Whether all bricks are drawn, or one. */
async function measurePage(count: number, bytes: Uint8Array, drawn: boolean): Promise<void> {
  const browser = await launch();
  const frames = !drawn ? 60 : count > 30_000 ? 10 : 40;
  const slow = drawn && count > 300_000; // half a minute a frame: it is only compared
  const site = await serve(bytes);
  const page = await browser.newPage({ viewport: kSize, reducedMotion: 'reduce' });
  const session = await page.context().newCDPSession(page);
  await page.addInitScript(kTicker);
  await page.addInitScript(counter(!drawn));
  const opened = await watchMainThread(browser);
  const began = performance.now();
  await page.goto(`${site.url}?still=off`);
  await page.waitForFunction(() => window.topple?.loaded && window.topple.frameCosts.length > 0, null, { timeout: 300000 });
  const took = (performance.now() - began) / 1000;
  await page.waitForTimeout(500); // the first frames after it belong to it
  const { frames: each, long } = await opened();
  const busy = each.map((one) => one.busy);
  console.log(drawn ? '  drawn by the processor:' : '  the same calls, one brick of them all drawn:');
  console.log(`  opening    ${took.toFixed(1)} s; the page's thread a frame: median ${at(busy, 0.5)} ms, 95 % ${at(busy, 0.95)} ms (${busy.length} frames); tasks over 8 ms: ${long.join(', ') || 'none'} ms`);
  await page.evaluate(() => Object.assign(window, { untick: true }));
  const box = (await page.locator('canvas').first().boundingBox())!;
  await page.waitForTimeout(2000); // what is made once, such as the shaders, is opening's
  if (!slow) await phases({ browser, page, session, frames }, box);
  console.log(`  memory     ${await memory(browser)}`);
  await page.keyboard.press('0'); // all of it in sight, as in the other's
  if (drawn) await compared(page, browser, { width: Math.round(box.width), height: Math.round(box.height) }, slow ? 1 : 8);
  await site.close();
  await browser.close();
}

interface Box {
  x: number;
  y: number;
}

async function phases(phase: Phase, box: Box): Promise<void> {
  const { page, frames } = phase;
  await page.mouse.move(box.x + 100, box.y + 100);
  await page.mouse.down();
  console.log(await measured(phase, 'orbiting', (i) => page.mouse.move(box.x + 100 + 6 * (i % 80), box.y + 100 + (i % 7))));
  await page.mouse.up();
  const strip = (await page.getByRole('slider', { name: 'Time', exact: true }).boundingBox())!;
  const scrub = (part: number): Promise<void> => page.mouse.move(strip.x + part * strip.width, strip.y + 20);
  await scrub(0.2);
  await page.mouse.down();
  console.log(await measured(phase, 'scrubbing', (i) => scrub(0.2 + (0.3 * i) / frames)));
  console.log(await measured({ ...phase, frames: Math.min(frames, 12) }, 'far scrubs', (i) => scrub(i % 2 ? 0.95 : 0.05)));
  await page.mouse.up();
  await page.locator('canvas').first().focus();
  await scrub(0.4);
  await page.keyboard.press('Space');
  console.log(await measured({ ...phase, frames: 1 }, 'playing', () => page.waitForTimeout(frames < 60 ? 4000 : 2000)));
  await page.keyboard.press('Space');
}

/** From frame to frame, ours beside the plainest mesh of the same bricks. */
async function compared(page: Page, browser: Browser, size: { width: number; height: number }, frames: number): Promise<void> {
  const own = await page.evaluate(async (n) => {
    const times: number[] = [];
    let last = NaN;
    for (let frame = 0; frame < n + 2; frame++) {
      await new Promise((next) => requestAnimationFrame(next));
      const now = performance.now();
      if (frame > 1) times.push(now - last);
      last = now;
      window.topple.swing(0.1);
    }
    return times.sort((a, b) => a - b)[Math.floor(times.length / 2)];
  }, frames);
  console.log(`  ours       ${own.toFixed(0)} ms from frame to frame`);
  const [feet, headings] = await page.evaluate(() => [Array.from(window.topple.feet), Array.from(window.topple.headings)]);
  await page.close();
  console.log(await plain(browser, size, feet, headings, frames));
}

const words = process.argv.slice(2);
for (const word of words) {
  const count = Number(word.replace('field:', ''));
  if (!count) continue;
  const bytes = word.startsWith('field:') ? await fieldOf(count) : repeatRecording(makeRecording({ count: 100 }), count, kHitStep);
  console.log(`${word}: ${count.toLocaleString('en-GB')} bricks, ${(bytes.length / 1e6).toFixed(0)} MB`);
  for (const drawn of [true, false]) if (!words.includes(drawn ? 'undrawn' : 'drawn')) await measurePage(count, bytes, drawn);
}
