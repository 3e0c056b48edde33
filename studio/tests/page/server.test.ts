/** The page as the program serves it: with its rules of what a page may do, its recording and its summary. */

import { spawn, type ChildProcess } from 'node:child_process';
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { afterAll, expect, test } from 'vitest';
import { kProgram, kRoot, launch } from './browser.ts';

let program: ChildProcess | null = null;
afterAll(() => {
  program?.kill('SIGINT');
});

test.skipIf(!existsSync(kProgram))('topple show: the page plays without a complaint', async () => {
  const child = spawn(kProgram, ['show', join(kRoot, 'studio/tests/page/row.toml'), '--no-browser'], { stdio: ['ignore', 'pipe', 'pipe'] });
  program = child;
  const url = await new Promise<string>((found, failed) => {
    let said = '';
    const hear = (words: Buffer): void => {
      said += String(words);
      const address = /http:\/\/(127\.0\.0\.1|localhost):\d+\/?/.exec(said);
      if (address) found(address[0]);
    };
    child.stdout?.on('data', hear);
    child.stderr?.on('data', hear);
    child.on('exit', () => failed(new Error(`topple show ended: ${said}`)));
  });
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
