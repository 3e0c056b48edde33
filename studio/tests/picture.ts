/**
 * The picture at the top of the README: `npx vite-node tests/picture.ts [--still n] [--theme light|dark] [--out FILE]`. A spiral in the
 * colours of the rainbow, run by the page's own engine, stopped in the middle of its wave, averaged to a still; taken by headless Chromium.
 */

import { fileURLToPath } from 'node:url';
import { spiralPoints } from '../src/draw/shapes.ts';
import { launch, serve } from './page/browser.ts';

const given = new Map<string, string>();
for (let i = 2; i < process.argv.length; i++) if (process.argv[i].startsWith('--')) given.set(process.argv[i].slice(2), process.argv[i + 1] ?? '');
const option = (name: string, otherwise: string): string => given.get(name) ?? otherwise;

/** Of a hue from 0 to 1, as bright to the eye as its neighbours. */
function rainbow(hue: number): string {
  const part = (shift: number): number => {
    const at = (hue + shift) % 1;
    return Math.min(1, Math.max(0, Math.abs(6 * at - 3) - 1));
  };
  const [r, g, b] = [part(0), part(2 / 3), part(1 / 3)];
  const light = 0.3 * r + 0.59 * g + 0.11 * b;
  return `#${[r, g, b].map((c) => Math.round(255 * Math.min(1, (0.08 + 0.92 * c) * (0.96 - 0.28 * light))).toString(16).padStart(2, '0')).join('')}`;
}

function layout(): string {
  const points = spiralPoints({ x: 0, y: 0 }, { x: 430, y: -300 }, 92);
  const bricks = 420;
  const paint = Array.from({ length: bricks }, (_, i) => `[${i}, ${i}, "${rainbow((0.98 + (0.86 * i) / 280) % 1)}"]`);
  return `title = "Rainbow spiral"\n\n[[push]]\nbrick = 0\nangular_speed_rad_s = 4\n\n[[curve]]\npoints_mm = [${points.map(({ x, y }) => `[${x.toFixed(1)}, ${y.toFixed(1)}]`).join(', ')}]\ngap_mm = 16.5\npaint = [${paint.join(', ')}]\n\n[model]\nname = "rigid"\n`;
}

const site = await serve(null);
const browser = await launch();
const page = await browser.newPage({ viewport: { width: 1440, height: 860 }, colorScheme: option('theme', 'light') as 'light' | 'dark', reducedMotion: 'reduce' });
page.on('pageerror', (error) => console.log('page error', error.message));
await page.goto(`${site.url}?still=off`);
await page.waitForFunction(() => window.topple?.mode === 'draw');
await page.getByLabel('Layout or recording file').setInputFiles({ name: 'spiral.toml', mimeType: 'application/toml', buffer: Buffer.from(layout()) });
await page.waitForFunction(() => window.topple.settled && window.topple.drawn > 0);
await page.locator('canvas').first().focus();
await page.keyboard.press('Space');
await page.waitForFunction(() => window.topple.hash !== '', null, { timeout: 300000 });
await page.keyboard.press('Space');
await page.evaluate(([time, look]) => {
  window.topple.seek(Number(time));
  const [x, y, z, a, b, c] = look.split(',').map(Number);
  window.topple.lookFrom([x, y, z], [a, b, c]);
}, [option('time', '3.75'), option('look', '-0.34,-1.10,0.66,0.03,-0.055,0.0')]);
await page.evaluate(() => (document.activeElement as HTMLElement).blur()); // no ring of the keyboard's focus
await page.mouse.move(5, 5);
await page.waitForTimeout(500);
await page.evaluate((n) => window.topple.finishStill(n), Number(option('still', '96')));
const path = option('out', fileURLToPath(new URL('../../docs/pictures/studio.jpg', import.meta.url)));
await page.screenshot({ path, type: 'jpeg', quality: 86, timeout: 120000 });
await browser.close();
await site.close();
