/**
 * What the page costs at N bricks: `npx vite-node tests/measure_page.ts 100000 field:100000 ...`: one row, or as many rows side by side as
 * a row has bricks, all pushed at once, run by the program (a wave a row: hundreds of times as much moves). Opening, orbiting, scrubbing and playing: the
 * page's own code in a frame (drawing calls included, the graphics card's work not), all scripts a frame by the sampling profiler; of
 * opening, all that the page's thread does from one frame to the next, by the browser's tracing;
 * the time from frame to frame beside that of a plain InstancedMesh of the same bricks in a canvas of the same size, memory.
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
import { kTicker, watchMainThread } from './main_thread.ts';
import { kProgram, launch, serve } from './page/browser.ts';
import { repeatRecording } from './repeat_recording.ts';

const kSize = { width: 720, height: 460 };

/** Watches the page's thread by the sampling profiler. @returns How to end it: all scripts and the collecting of garbage [ms]. */
async function watchWork(session: CDPSession): Promise<() => Promise<number>> {
  await session.send('Profiler.enable');
  await session.send('Profiler.start');
  return async () => {
    const { profile } = await session.send('Profiler.stop');
    const idle = new Set(profile.nodes.filter(({ callFrame }) => ['(idle)', '(program)'].includes(callFrame.functionName)).map(({ id }) => id));
    return (profile.samples ?? []).reduce((sum, id, i) => sum + (idle.has(id) ? 0 : (profile.timeDeltas?.[i] ?? 0) / 1000), 0);
  };
}

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

/** Does something for so many frames. @returns A line of figures. */
async function measured(page: Page, session: CDPSession, name: string, frames: number, step: (i: number) => Promise<unknown>): Promise<string> {
  await page.evaluate(() => ((window as never as { topple: { frameCosts: number[] } }).topple.frameCosts.length = 0));
  const work = await watchWork(session);
  const drawn = (): Promise<number> => page.evaluate(() => window.topple.frameCosts.length);
  for (let i = 0; i < frames; i++) {
    const before = await drawn();
    await step(i);
    await page.waitForFunction((n) => window.topple.frameCosts.length > n, before, { timeout: 120000, polling: 'raf' }).catch(() => undefined);
  }
  const busy = await work();
  const costs = (await page.evaluate(() => [...window.topple.frameCosts])).sort((a, b) => a - b);
  const at = (part: number): string => (costs[Math.floor(part * (costs.length - 1))] ?? NaN).toFixed(2);
  return `  ${name.padEnd(10)} median ${at(0.5)} ms, 95 % ${at(0.95)} ms of the page's own code in ${costs.length} frames; ${(busy / costs.length).toFixed(2)} ms of scripts in all a frame`;
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

for (const word of process.argv.slice(2)) {
  const count = Number(word.replace('field:', ''));
  if (!count) continue;
  const browser = await launch();
  const frames = count > 300_000 ? 2 : count > 30_000 ? 8 : 20;
  const bytes = word.startsWith('field:') ? await fieldOf(count) : repeatRecording(makeRecording({ count: 100 }), count, kHitStep);
  const site = await serve(bytes);
  const page = await browser.newPage({ viewport: kSize, reducedMotion: 'reduce' });
  const session = await page.context().newCDPSession(page);
  await page.addInitScript(kTicker);
  const opened = await watchMainThread(browser);
  const began = performance.now();
  await page.goto(`${site.url}?still=off`);
  await page.waitForFunction(() => window.topple?.loaded && window.topple.frameCosts.length > 0, null, { timeout: 300000 });
  const took = (performance.now() - began) / 1000;
  await page.waitForTimeout(500); // the first frames after it belong to it
  const { frames: busy, long } = await opened();
  const part = (share: number): string => (busy[Math.floor(share * (busy.length - 1))] ?? NaN).toFixed(2);
  console.log(`${word}: ${count.toLocaleString('en-GB')} bricks, ${(bytes.length / 1e6).toFixed(0)} MB`);
  console.log(`  opening    ${took.toFixed(1)} s; the page's thread a frame: median ${part(0.5)} ms, 95 % ${part(0.95)} ms in ${busy.length} frames; tasks over 8 ms: ${long.join(', ') || 'none'} ms`);
  const box = (await page.locator('canvas').first().boundingBox())!;
  await page.waitForTimeout(2000); // what is made once, such as the shaders, is opening's
  await page.mouse.move(box.x + 100, box.y + 100);
  await page.mouse.down();
  console.log(await measured(page, session, 'orbiting', frames, (i) => page.mouse.move(box.x + 100 + 6 * i, box.y + 100 + (i % 7))));
  await page.mouse.up();
  const strip = (await page.getByRole('slider', { name: 'Time', exact: true }).boundingBox())!;
  await page.mouse.move(strip.x + 0.2 * strip.width, strip.y + 20);
  await page.mouse.down();
  console.log(await measured(page, session, 'scrubbing', frames, (i) => page.mouse.move(strip.x + (0.2 + (0.6 * i) / frames) * strip.width, strip.y + 20)));
  await page.mouse.up();
  console.log(`  memory     ${await memory(browser)}`);
  {
    await page.mouse.down();
    console.log(await measured(page, session, 'far scrubs', Math.min(frames, 6), (i) => page.mouse.move(strip.x + (i % 2 ? 0.95 : 0.05) * strip.width, strip.y + 20)));
    await page.mouse.up();
    await page.locator('canvas').first().focus();
    await page.keyboard.press('Space');
    console.log(await measured(page, session, 'playing', frames, () => Promise.resolve()));
    await page.keyboard.press('Space');
  }
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
  console.log(await plain(browser, { width: Math.round(box.width), height: Math.round(box.height) }, feet, headings, frames));
  await site.close();
  await browser.close();
}
