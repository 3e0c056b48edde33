/** The page as the program serves it: with its rules of what a page may do, its recording and its summary. */

import { spawn, type ChildProcess } from 'node:child_process';
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { afterAll, expect, test } from 'vitest';
import { kProgram, kRoot, launch, toppled } from './browser.ts';

const programs: ChildProcess[] = [];
afterAll(() => programs.forEach((program) => program.kill('SIGINT')));

/** Starts `topple` with a verb that serves. @returns Its address. */
function serving(...words: string[]): Promise<string> {
  const child = spawn(kProgram, words, { stdio: ['ignore', 'pipe', 'pipe'] });
  programs.push(child);
  return new Promise<string>((found, failed) => {
    let said = '';
    const hear = (heard: Buffer): void => {
      said += String(heard);
      const address = /http:\/\/(127\.0\.0\.1|localhost):\d+\//.exec(said); // all of it: words may come in pieces
      if (address) found(address[0]);
    };
    child.stdout?.on('data', hear);
    child.stderr?.on('data', hear);
    child.on('exit', () => failed(new Error(`topple ${words[0]} ended: ${said}`)));
  });
}

test.skipIf(!existsSync(kProgram))('topple show: the page plays without a complaint', async () => {
  const url = await serving('show', join(kRoot, 'studio/tests/page/row.toml'), '--no-browser');
  const browser = await launch();
  const page = await browser.newPage({ viewport: { width: 1000, height: 560 }, reducedMotion: 'reduce' });
  const complaints: string[] = [];
  page.on('console', (message) => message.type() === 'error' && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(error.message));
  await page.goto(`${url.replace(/\/$/, '')}/?still=off`);
  await page.waitForFunction(() => window.topple?.loaded);
  await page.keyboard.press('End');
  await expect.poll(() => page.evaluate(() => window.topple.fallen)).toBe(12);
  await page.keyboard.press('n');
  await expect.poll(() => page.locator('.u-wrap canvas').count()).toBe(3);
  expect(complaints).toEqual([]);
  await browser.close();
});

test.skipIf(!existsSync(kProgram))('a long layout is run by the program: the same hash, and it can be stopped; a short one by the page', async () => {
  const url = await serving('studio');
  const browser = await launch();
  const page = await browser.newPage({ viewport: { width: 800, height: 500 }, reducedMotion: 'reduce' });
  const complaints: string[] = [];
  const orders: string[] = [];
  page.on('console', (message) => message.type() === 'error' && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(error.message));
  page.on('request', (request) => request.method() === 'POST' && orders.push(request.url()));
  await page.goto(`${url.replace(/\/$/, '')}/?still=off`);
  const open = async (text: string): Promise<void> => {
    await page.getByLabel('Layout or recording file').setInputFiles({ name: 'long.toml', mimeType: 'application/toml', buffer: Buffer.from(text) });
    await page.waitForFunction((wanted) => window.topple.text === wanted && window.topple.settled && window.topple.mode === 'draw', text);
    await page.locator('canvas').first().focus();
  };
  const row = (count: number, model = 'hinge'): string => `[[push]]\nangular_speed_rad_s = 4\n\n[[row]]\ncount = ${count}\ngap_mm = 16.5\n\n[model]\nname = "${model}"\n`;

  await open(row(40));
  await page.keyboard.press('Space');
  await toppled(page);
  expect(orders).toEqual([]);

  await open(row(3500));
  await page.keyboard.press('Space');
  await toppled(page);
  await expect.poll(() => orders.length).toBe(1);
  expect(await page.evaluate(() => window.topple.hash)).toBe(await page.evaluate((text) => window.topple.runHash(text), row(3500)));
  await page.keyboard.press('End');
  await expect.poll(() => page.evaluate(() => window.topple.fallen)).toBe(3500);

  // A ball that nothing slows down rolls for ever: it is stopped, and the program lets go of it, so that the next run is taken; whether
  // it is left before the program has even answered, or once it is seen.
  const endless = `${row(3100, 'rigid')}\n[[ball]]\nat_mm = [0, 500]\nheading_deg = 90\nspeed_m_s = 0.1\nrolling_friction = 0\n`;
  const draw = page.getByRole('button', { name: 'Draw', exact: true });
  await open(endless);
  programs.at(-1)?.kill('SIGSTOP');
  await page.keyboard.press('Space');
  await expect.poll(() => orders.length).toBe(2);
  await draw.click();
  programs.at(-1)?.kill('SIGCONT');
  await open(row(3300));
  await page.keyboard.press('Space');
  await toppled(page);
  await draw.click();
  await open(endless);
  await page.keyboard.press('Space');
  await expect.poll(() => page.evaluate(() => window.topple.duration)).toBeGreaterThan(0);
  await draw.click();
  await open(row(3600));
  await page.keyboard.press('Space');
  await toppled(page);
  await expect.poll(() => orders.length).toBe(5);
  expect(complaints).toEqual([]);
  await browser.close();
});
