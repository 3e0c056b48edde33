/**
 * Pictures of the page, to be looked at: `npx vite-node tests/shoot.ts -- --size 1440x900 --theme dark --time 0.5 --out a.png`.
 * Options: --recording FILE (else made up, --shape row|s_curve --count n), --way orbit|front|eye|top, --choose n, --still frames,
 * --look x,y,z,x,y,z (from, at), --open (phone's sheet, panel).
 */

import { readFile } from 'node:fs/promises';
import { launch, makeRecording, serve } from './page/browser.ts';

const given = new Map<string, string>();
for (let i = 2; i < process.argv.length; i++) {
  if (process.argv[i].startsWith('--')) given.set(process.argv[i].slice(2), process.argv[i + 1] ?? '');
}
const option = (name: string, otherwise: string): string => given.get(name) ?? otherwise;

const file = given.get('recording');
const shape = option('shape', 's_curve') as 'row' | 's_curve';
const bytes = file ? new Uint8Array(await readFile(file)) : makeRecording({ count: Number(option('count', '200')), shape });
const site = await serve(bytes);
const browser = await launch(option('webgl', 'yes') === 'yes');
const [width, height] = option('size', '1440x900').split('x').map(Number);
const page = await browser.newPage({
  viewport: { width, height },
  deviceScaleFactor: Number(option('scale', '1')),
  colorScheme: option('theme', 'light') as 'light' | 'dark',
  reducedMotion: 'reduce',
  hasTouch: width < 720,
});
page.on('console', (message) => ['error', 'warning'].includes(message.type()) && console.log(message.type(), message.text()));
page.on('pageerror', (error) => console.log('page error', error.message));
await page.goto(site.url + '?still=off');
await page.waitForFunction(() => window.topple?.loaded, null, { timeout: 60000 });
await page.evaluate(
  async ([time, way, look]) => {
    window.topple.seek(Number(time) < 0 ? window.topple.duration : Number(time));
    if (way) window.topple.setWay(way as never);
    const numbers = look.split(',').map(Number);
    if (numbers.length === 6) window.topple.lookFrom(numbers.slice(0, 3) as never, numbers.slice(3) as never);
  },
  [option('time', '0'), option('way', ''), option('look', '')],
);
const chosen = Number(option('choose', '-1'));
await page.waitForTimeout(700);
if (chosen >= 0) await page.evaluate((n) => window.topple.choose(n), chosen);
if (given.has('open')) await page.getByRole('button', { name: width < 720 ? 'Details' : 'Panel' }).click();
for (const key of option('keys', '').split(' ').filter(Boolean)) await page.keyboard.press(key);
await page.waitForTimeout(700);
const frames = Number(option('still', '0'));
if (frames) await page.evaluate((n) => window.topple.finishStill(n), frames);
await page.screenshot({ path: option('out', 'tests/out/shot.png'), timeout: 120000 });
await browser.close();
await site.close();
