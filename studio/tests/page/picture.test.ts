/** An image as a field: the dialog, what it puts on the table, stock, and how it falls. */

import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, beforeEach, expect, test } from 'vitest';
import { kRoot, launch, serve, type Site } from './browser.ts';

let browser: Browser;
let site: Site;
let page: Page;
const kAxe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const boat = readFileSync(join(kRoot, 'scenes/picture.png'));
const complaints: string[] = [];

beforeAll(async () => {
  site = await serve(null);
  browser = await launch();
});
afterAll(async () => {
  await browser?.close();
  await site?.close();
});
beforeEach(async () => {
  await page?.context().close();
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, reducedMotion: 'reduce' });
  page = await context.newPage();
  page.on('console', (message) => message.type() === 'error' && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(error.message));
  await page.goto(`${site.url}?still=off`);
  await page.waitForFunction(() => window.topple?.mode === 'draw');
});

const text = (): Promise<string> => page.evaluate(() => window.topple.text);
const drawn = (): Promise<number> => page.evaluate(() => window.topple.drawn);
const dialog = (): ReturnType<Page['getByRole']> => page.getByRole('dialog', { name: 'Picture' });
async function put(): Promise<void> {
  await page.getByRole('button', { name: 'Put on the table' }).click();
  await dialog().waitFor({ state: 'detached' });
  await page.waitForFunction(() => window.topple.settled && window.topple.drawn > 0);
}
async function open(bricks: number): Promise<void> {
  await page.getByLabel('Layout or recording file').setInputFiles({ name: 'boat.png', mimeType: 'image/png', buffer: boat });
  await dialog().getByLabel('Bricks', { exact: true }).fill(String(bricks));
  await dialog().getByLabel('Bricks', { exact: true }).press('Tab');
  await expect.poll(() => dialog().locator('.told').textContent()).toMatch(/rows of/);
}

test('an image becomes a field in one step of undo, and all of it falls', async () => {
  await open(300);
  // 600 by 400 pixels, a brick 16 by 32 mm: three bricks a row for each row.
  await expect.poll(() => dialog().locator('.told').textContent()).toBe('10 rows of 30, 300 bricks, 0.48 × 0.32 m. Rows fall to the right.');
  await put();
  await expect.poll(drawn).toBe(300);
  const written = await text();
  expect(written).toMatch(/\[\[field\]\]\nfrom_mm = \[-240, -160\]\ngap_mm = 8\.5\nrow_pitch_mm = 32\nstarter = "pushes"\nangular_speed_rad_s = 10\npalette = \{[^\n]*\}\npicture = \[\n(  "[^"]{30}",\n){10}\]/);
  expect(written).not.toMatch(/\[\[push\]\]/);
  // The sky is violet, and the sea is blue.
  const lines = [...written.matchAll(/^ {2}"(.*)",$/gm)].map((found) => found[1]);
  expect(lines[0]).toMatch(/^v{9}/);
  expect(lines[9]).toMatch(/^B{9}/);
  await page.keyboard.press('Control+z');
  await expect.poll(text).not.toMatch(/picture/);
  await page.keyboard.press('Control+Shift+z');
  await expect.poll(drawn).toBe(300);
  // Chosen, it is marked row by row and as long as its rows together: ten times 29 pitches of 16 mm.
  await page.keyboard.press('Control+a');
  await expect.poll(() => page.locator('polyline.spine').count()).toBe(10);
  await expect.poll(() => page.getByText('300 bricks, 4.64 m').count()).toBeGreaterThan(0);
  await page.getByRole('button', { name: 'Topple' }).click();
  await expect.poll(() => page.evaluate(() => window.topple.hash)).toMatch(/^[0-9a-f]{16}$/);
  await page.evaluate(() => window.topple.seek(window.topple.duration));
  await expect.poll(() => page.evaluate(() => window.topple.fallen)).toBe(300);
});

test('of a colour never more bricks are taken than there are, and what is missing is said', async () => {
  await open(300);
  await dialog().getByLabel('Violet available').fill('10');
  await dialog().getByLabel('Violet available').press('Tab');
  await expect.poll(() => dialog().getByRole('listitem').filter({ hasText: 'Violet' }).locator('b').textContent()).toBe('10');
  await dialog().getByRole('button', { name: 'Only those in stock' }).click();
  await expect.poll(() => dialog().getByRole('alert').textContent()).toMatch(/The picture takes 300 bricks, and of these colours there are 10 bricks: 290 are missing\./);
  expect(await page.getByRole('button', { name: 'Put on the table' }).isDisabled()).toBe(true);
  await dialog().getByLabel('Black', { exact: true }).check();
  await expect.poll(() => dialog().getByRole('alert').count()).toBe(0);
  await put();
  await expect.poll(drawn).toBe(300);
  const lines = [...(await text()).matchAll(/^ {2}"(.*)",$/gm)].map((found) => found[1]).join('');
  expect([...lines].filter((letter) => letter === 'v').length).toBe(10);
  expect([...lines].filter((letter) => letter === '#').length).toBe(290);
});

test('a line along the heads starts a picture, mixed or not; its panel keeps rows and bricks as they are', async () => {
  await page.getByRole('button', { name: 'Picture', exact: true }).click();
  await dialog().getByLabel('Image file').setInputFiles({ name: 'boat.png', mimeType: 'image/png', buffer: boat });
  await dialog().getByLabel('Start').selectOption('line');
  const before = dialog().getByRole('listitem').filter({ hasText: 'Teal' }).locator('b');
  await expect.poll(() => before.textContent()).toMatch(/\d/);
  const plain = await before.textContent();
  await dialog().getByLabel('colours over neighbouring bricks').check();
  await expect.poll(() => before.textContent()).not.toBe(plain);
  await put();
  await page.waitForFunction(() => window.topple.settled && window.topple.drawn > 1500);
  expect(await text()).toMatch(/\[\[push\]\]\nbrick = 0[\s\S]*starter = "line"/);
  expect(await page.evaluate(() => window.topple.doubts)).toEqual([]);
  await page.keyboard.press('Control+a');
  await expect.poll(() => page.getByRole('heading', { name: 'Field 1' }).count()).toBe(1);
  expect(await page.getByLabel('Rows', { exact: true }).count()).toBe(0);
});

test('what is no image changes nothing, and the dialog is fit for all', async () => {
  await page.getByLabel('Layout or recording file').setInputFiles({ name: 'bad.png', mimeType: 'image/png', buffer: Buffer.from('no image') });
  await expect.poll(() => dialog().getByRole('alert').textContent()).toMatch(/bad\.png is no image that this browser can read\./);
  expect(await page.getByRole('button', { name: 'Put on the table' }).isDisabled()).toBe(true);
  await page.evaluate(kAxe);
  const found = await page.evaluate(async () => (await (window as unknown as { axe: { run(of: string): Promise<{ violations: { id: string }[] }> } }).axe.run('dialog')).violations.map((one) => one.id));
  expect(found).toEqual([]);
  await page.keyboard.press('Escape');
  await expect.poll(() => dialog().count()).toBe(0);
  expect(await drawn()).toBe(0);
});

test('the console stayed quiet', () => {
  expect(complaints).toEqual([]);
});
