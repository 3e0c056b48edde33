/**
 * Pictures of every step of a new user's way, to be looked at: `npx vite-node tests/shoot_steps.ts [1440x900|390x844 [light|dark]] [part ...]`,
 * parts: steps, scenes, clear, film. They go to tests/out/steps/.
 */

import { mkdir, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { kOut, launch, serve } from './page/browser.ts';

const folder = join(kOut, 'steps');
const asked = process.argv.slice(2);
const sizes = asked.filter((word) => /^\d+x\d+$/.test(word));
const themes = asked.filter((word) => word === 'light' || word === 'dark') as ('light' | 'dark')[];
const parts = asked.filter((word) => /^(steps|scenes|clear|film)$/.test(word));
const wanted = (part: string): boolean => parts.length === 0 || parts.includes(part);

await mkdir(folder, { recursive: true });
const site = await serve(null);
const browser = await launch();

async function open(size: string, colorScheme: 'light' | 'dark'): Promise<{ page: Page; shoot: (name: string) => Promise<void>; phone: boolean }> {
  const [width, height] = size.split('x').map(Number);
  const phone = width < 720;
  const context = await browser.newContext({ viewport: { width, height }, colorScheme, reducedMotion: 'reduce', hasTouch: phone, isMobile: phone });
  const page = await context.newPage();
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && !/GPU stall/.test(message.text()) && console.log(message.type(), message.text()));
  page.on('pageerror', (error) => console.log('page error', error.message));
  await page.goto(`${site.url}?still=off`);
  await page.waitForFunction(() => window.topple?.mode === 'draw');
  const shoot = async (name: string): Promise<void> => {
    await page.waitForTimeout(250);
    await page.screenshot({ path: join(folder, `${name}-${width}-${colorScheme}.png`), timeout: 120000 });
  };
  return { page, shoot, phone };
}

async function steps(size: string, theme: 'light' | 'dark'): Promise<void> {
  const { page, shoot, phone } = await open(size, theme);
  const at = async (x: number, y: number): Promise<{ x: number; y: number }> => (await page.evaluate(([a, b]) => window.topple.pixelAt(a, b), [x, y]))!;
  const tool = (name: string): Promise<void> => page.getByRole('button', { name, exact: true }).click();
  await shoot('01-empty');
  await tool('S');
  const [from, to] = phone ? [await at(-500, 0), await at(500, 0)] : [await at(-450, 0), await at(250, 0)];
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move((from.x + to.x) / 2, (from.y + to.y) / 2, { steps: 3 });
  await page.mouse.move(to.x, to.y, { steps: 3 });
  await shoot('02-drawing');
  await page.mouse.up();
  await page.waitForFunction(() => window.topple.drawn > 20);
  await shoot('03-drawn');
  await tool('Split');
  const end = phone ? await at(493, -4) : await at(243, -4);
  await page.mouse.click(end.x, end.y);
  await page.waitForTimeout(1500);
  await shoot('04-split');
  await tool('Brick');
  const far = await at(-300, -330);
  await page.mouse.click(far.x, far.y);
  await page.waitForFunction(() => window.topple.doubts.length > 0);
  await page.waitForTimeout(1500);
  if (phone) await page.getByRole('button', { name: 'Panel' }).click();
  await shoot('05-warning');
  if (phone) await page.getByRole('button', { name: 'Panel' }).click();
  await page.locator('canvas').first().focus();
  await page.keyboard.press('Control+z');
  await page.keyboard.press('0');
  await page.keyboard.press('Escape');
  await page.keyboard.press('n');
  await page.waitForTimeout(1200);
  await shoot('06-chosen');
  await page.keyboard.press('Space');
  await page.waitForTimeout(500);
  await shoot('07-running');
  await page.waitForFunction(() => window.topple.hash !== '', null, { timeout: 60000 });
  await page.evaluate(() => window.topple.seek(0.8));
  await shoot('08-watching');
  await page.evaluate(() => window.topple.choose(12));
  await shoot('09-brick');
  await page.evaluate(() => window.topple.choose(-1));
  if (phone) await page.getByRole('button', { name: 'Show', exact: true }).click();
  for (const name of ['Hits', 'Trace', 'Ghost']) await page.getByRole('button', { name, exact: true }).click();
  await shoot('10-looks');
  await page.locator('#heat').selectOption('speed');
  await shoot('11-heat');
  await page.locator('#heat').selectOption('');
  for (const name of ['Hits', 'Trace', 'Ghost']) await page.getByRole('button', { name, exact: true }).click();
  for (const way of ['front', 'eye', 'top'] as const) {
    await page.evaluate((one) => window.topple.setWay(one), way);
    await shoot(`12-${way}`);
  }
  await page.evaluate(() => window.topple.setWay('orbit'));
  if (!phone) {
    await page.getByRole('button', { name: 'Film' }).click();
    await shoot('13-film');
    await page.keyboard.press('Escape');
    await page.keyboard.press('?');
    await shoot('14-keys');
    await page.keyboard.press('Escape');
  } else {
    await page.getByRole('button', { name: 'More' }).click();
    await shoot('13-more');
    await page.getByRole('button', { name: 'More' }).click();
    await page.getByRole('button', { name: 'Details' }).click();
    await shoot('14-details');
    await page.getByRole('button', { name: 'Details' }).click();
  }
  await page.getByRole('button', { name: 'Compare' }).click();
  await page.getByRole('article', { name: 'Rigid' }).getByText('Hash').waitFor({ timeout: 60000 });
  await page.getByLabel('Time').fill('0.8');
  await shoot('15-compare');
  await page.getByRole('button', { name: 'Draw', exact: true }).click();
  if (phone) await page.getByRole('button', { name: 'More' }).click();
  await page.getByRole('button', { name: 'Scenes' }).click();
  await shoot('16-scenes');
  await page.context().close();
}

async function scenes(): Promise<void> {
  const { page, shoot } = await open('1440x900', 'light');
  await page.getByRole('button', { name: 'Scenes' }).click();
  const names = await page.getByRole('dialog').getByRole('listitem').locator('b').allInnerTexts();
  await page.keyboard.press('Escape');
  for (const name of names) {
    await page.getByRole('button', { name: 'Scenes' }).click();
    await page.getByRole('dialog').getByRole('button', { name }).click();
    await page.waitForTimeout(2500);
    await shoot(`scene-${name.replaceAll(' ', '-')}`);
  }
  await page.context().close();
}

async function pictures(): Promise<void> {
  const { page } = await open('1440x900', 'light');
  await page.getByRole('button', { name: 'Scenes' }).click();
  await page.getByRole('dialog').getByRole('button', { name: 'An S that forks' }).click();
  await page.waitForFunction(() => window.topple.drawn > 0);
  await page.keyboard.press('Space');
  await page.waitForFunction(() => window.topple.hash !== '', null, { timeout: 60000 });
  await page.keyboard.press('Space');
  await page.evaluate(() => window.topple.seek(1));
  if (wanted('clear')) {
    const download = page.waitForEvent('download');
    await page.getByRole('button', { name: 'Picture' }).click({ modifiers: ['Shift'] });
    await (await download).saveAs(join(folder, 'clear.png'));
  }
  if (!wanted('film')) return;
  const film = await page.evaluate(async () => {
    const bytes = await window.topple.film({ format: 'webm', camera: 'front', width: 960, height: 540, fps: 10, speed: 1, from: 0.6, to: 1, sound: true, samples: 8 });
    return Array.from(bytes);
  });
  await writeFile(join(folder, 'film.webm'), Uint8Array.from(film));
  await page.context().close();
}

for (const size of sizes.length ? sizes : ['1440x900', '390x844']) {
  for (const theme of themes.length ? themes : (['light', 'dark'] as const)) if (wanted('steps')) await steps(size, theme);
}
if (wanted('scenes')) await scenes();
if (wanted('clear') || wanted('film')) await pictures();
await browser.close();
await site.close();
