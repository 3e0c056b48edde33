/**
 * What a frame costs the page's main thread at N bricks while it plays (drawing calls included, the graphics card's work not):
 * `npx vite-node tests/measure_page.ts`. The canvas is tiny, since here it may be drawn by the processor.
 */

import { kHitStep, makeRecording } from './make_recording.ts';
import { launch, serve } from './page/browser.ts';
import { repeatRecording } from './repeat_recording.ts';

const browser = await launch();
for (const count of process.argv.slice(2).map(Number).filter(Boolean)) {
  const site = await serve(repeatRecording(makeRecording({ count: 100 }), count, kHitStep));
  const page = await browser.newPage({ viewport: { width: 400, height: 420 }, reducedMotion: 'reduce' });
  const began = performance.now();
  await page.goto(`${site.url}?still=off`);
  await page.waitForFunction(() => window.topple?.loaded, null, { timeout: 120000 });
  const loaded = performance.now() - began;
  await page.evaluate(() => window.topple.seek(0.4 * window.topple.duration));
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  await page.keyboard.press('Space');
  await page.waitForTimeout(8000);
  await page.keyboard.press('Space');
  const costs = await page.evaluate(() => window.topple.frameCosts.slice(2));
  const sorted = [...costs].sort((a, b) => a - b);
  const at = (part: number): string => (sorted[Math.floor(part * (sorted.length - 1))] ?? NaN).toFixed(2);
  console.log(`${count} bricks: open after ${(loaded / 1000).toFixed(1)} s; a frame takes ${at(0.5)} ms (median of ${costs.length}), 95 %: ${at(0.95)} ms`);
  await page.close();
  await site.close();
}
await browser.close();
