/** The page when something is missing or wrong, and at every size. */

import { mkdir, readFile } from 'node:fs/promises';
import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { makeFragment } from '../../src/draw/link.ts';
import { drawn, kOut, kRoot, launch, makeRecording, recordingOf, serve, toppled, type Site } from './browser.ts';

let browser: Browser;
let site: Site;

beforeAll(async () => {
  const { bytes } = await recordingOf('studio/tests/page/row.toml', () => makeRecording({ count: 12 }));
  site = await serve(bytes);
  browser = await launch();
  await mkdir(kOut, { recursive: true });
});
afterAll(async () => {
  await browser?.close();
  await site?.close();
});

describe('what cannot be shown is said in words', () => {
  async function expectWords(recording: Uint8Array | null, words: RegExp): Promise<void> {
    const other = await serve(recording);
    const page = await browser.newPage({ viewport: { width: 800, height: 500 } });
    await page.goto(other.url);
    await expect.poll(() => page.locator('.empty').innerText()).toMatch(words);
    await page.close();
    await other.close();
  }

  test('no recording: a bare table to draw on', async () => {
    await expectWords(null, /Draw a line. Bricks will stand along it/);
  });

  test('a foreign file', async () => {
    await expectWords(new TextEncoder().encode('something else entirely'), /not a recording of Topple/);
  });

  test('a damaged file', async () => {
    const bytes = makeRecording({ count: 5 });
    bytes[400] ^= 1;
    await expectWords(bytes, /Damaged in the piece \w{4} at byte \d+/);
  });

  test('a file that is dropped takes the place of what was open, a bad one leaves it', async () => {
    const page = await browser.newPage({ viewport: { width: 800, height: 500 } });
    await page.goto(`${site.url}?still=off`);
    await page.waitForFunction(() => window.topple?.loaded);
    const give = (name: string, bytes: Uint8Array): Promise<void> =>
      page.getByLabel('Layout or recording file').setInputFiles({ name, mimeType: 'application/octet-stream', buffer: Buffer.from(bytes) });
    await give('bad.topple', new TextEncoder().encode('TOPPLE01 and nothing more'));
    await expect.poll(() => page.getByRole('alert').innerText()).toMatch(/What was open is untouched/);
    expect(await page.evaluate(() => window.topple.bricks)).toBe(12);
    await give('seven.topple', makeRecording({ count: 7 }));
    await expect.poll(() => page.evaluate(() => window.topple.bricks)).toBe(7);
    await expect.poll(() => page.getByRole('alert').count()).toBe(0);
    await page.close();
  });

  test('without WebGL a sentence and a plan stand in for the view; numbers, plots and playing still work', async () => {
    const plain = await launch(false);
    const page = await plain.newPage({ viewport: { width: 1100, height: 640 } });
    await page.goto(site.url);
    await page.waitForFunction(() => window.topple?.loaded);
    await expect.poll(() => page.locator('.plan [role=status]').innerText()).toMatch(/no WebGL 2\. Plots and numbers still work/);
    await page.keyboard.press('End');
    await expect.poll(() => page.locator('[data-test=read-out]').innerText()).toMatch(/12 \/ 12/);
    await page.keyboard.press('n');
    await expect.poll(() => page.locator('.u-wrap canvas').count()).toBe(3);
    await expect.poll(() => page.evaluate(() => window.topple.drawnTilt(11))).toBeGreaterThan(1.5);
    await page.screenshot({ path: `${kOut}/no-webgl.png` });
    await plain.close();
  });
});

test('a link opened without WebGL: a sentence, the layout is there, it can be run, and the next visit has it too', async () => {
  const text = '[[push]]\nangular_speed_rad_s = 4\n\n[[row]]\ncount = 9\ngap_mm = 16.5\n\n[model]\nname = "hinge"\n';
  const bare = await serve(null);
  const plain = await launch(false);
  const page = await plain.newPage({ viewport: { width: 1100, height: 640 } });
  await page.goto(`${bare.url}${await makeFragment({ text, hash: '' })}`);
  await page.waitForFunction(() => window.topple?.drawn === 9 && window.topple.settled);
  await expect.poll(() => page.locator('.plan [role=status]').innerText()).toMatch(/no WebGL 2[\s\S]*Layouts can be opened and run/);
  await expect.poll(() => page.locator('.empty').count()).toBe(0); // nothing lies over the plan
  await page.getByRole('button', { name: /Topple/ }).click();
  await toppled(page);
  await page.keyboard.press('End');
  await expect.poll(() => page.locator('[data-test=read-out]').innerText()).toMatch(/9 \/ 9/);
  await page.goto('about:blank');
  await page.goto(bare.url);
  await expect.poll(() => page.evaluate(() => window.topple?.text)).toBe(text);
  await plain.close();
  await bare.close();
});

test('bricks put down by hand: how often all falls and where it stops; a stop keeps what is done, other errors begin anew', async () => {
  const bare = await serve(null);
  const page = await browser.newPage({ viewport: { width: 1300, height: 800 }, reducedMotion: 'reduce' });
  const text = await readFile(`${kRoot}/scenes/by_hand.toml`, 'utf8');
  await page.goto(`${bare.url}?still=off${await makeFragment({ text, hash: '' })}`);
  await page.waitForFunction(() => window.topple?.drawn === 73 && window.topple.settled);
  await page.getByRole('button', { name: /Topple/ }).click();
  await toppled(page);
  await page.evaluate(() => window.topple.pause());
  const study = page.getByRole('region', { name: 'Put down by hand' });
  await study.getByLabel('Runs', { exact: true }).selectOption('20');
  await study.getByRole('button', { name: 'Run', exact: true }).click();
  // `topple risk scenes/by_hand.toml --runs 20`
  await expect.poll(() => study.innerText()).toMatch(/60\u00a0% all fall[\s\S]*In 12 of 20 runs; the true share is likely 39 to 78\u00a0%/);
  await study.getByRole('button', { name: 'Run more' }).waitFor();
  expect(await study.innerText()).toMatch(/Brick 39\s+row 3\s+40\u00a0%/);
  await study.getByRole('button', { name: 'Show it in colours' }).click();
  await expect.poll(() => page.locator('#heat').inputValue()).toBe('risk');
  await study.getByLabel('Runs', { exact: true }).selectOption('2000');
  await study.getByRole('button', { name: 'Run more' }).click();
  await expect.poll(() => study.innerText()).toMatch(/(2[1-9]|[3-9]\d|\d{3,}) of 2,020 runs/);
  await study.getByRole('button', { name: 'Stop' }).click();
  await study.getByRole('button', { name: 'Run more' }).waitFor();
  const counted = /In [\d,]+ of ([\d,]+) runs/.exec(await study.innerText());
  expect(Number(counted?.[1].replace(',', ''))).toBeGreaterThanOrEqual(20);
  await study.getByLabel('Off by').fill('0');
  await study.getByLabel('Turned by').fill('0');
  await study.getByLabel('Runs', { exact: true }).selectOption('20');
  await study.getByRole('button', { name: 'Run', exact: true }).click();
  await expect.poll(() => study.innerText()).toMatch(/100\u00a0% all fall[\s\S]*In 20 of 20 runs[\s\S]*0 mm and 0°[\s\S]*All 73 bricks never stopped it/);
  await expect.poll(() => page.locator('#heat').inputValue()).toBe(''); // the colours were of what is forgotten
  await page.close();
  await bare.close();
});

describe('at every size', () => {
  const sizes = [
    [360, 640], [390, 844], [800, 600], [1000, 420], [1300, 700], [1920, 1080], [3840, 2160],
  ];
  test('nothing sticks out, and the view fills what is left', async () => {
    const page = await browser.newPage({ viewport: { width: 360, height: 640 }, reducedMotion: 'reduce' });
    await page.goto(`${site.url}?still=off`);
    await page.waitForFunction(() => window.topple?.loaded);
    for (const [width, height] of sizes) {
      await page.setViewportSize({ width, height });
      await expect
        .poll(() =>
          page.evaluate(() => {
            const view = document.querySelector('.view')!;
            const canvas = view.querySelector('canvas')!;
            const root = document.documentElement;
            const buttons = [...document.querySelectorAll('header button, footer button')].filter((b) => b.getClientRects().length > 0);
            return {
              wide: root.scrollWidth > innerWidth || document.body.scrollHeight > innerHeight,
              view: view.clientWidth > 0.5 * innerWidth && view.clientHeight > 0.25 * innerHeight,
              canvas: canvas.width >= view.clientWidth && canvas.height >= view.clientHeight,
              panel: [...document.querySelectorAll('.panel')].every((one) => one.scrollWidth <= one.clientWidth),
              cut: buttons.some((b) => b.getBoundingClientRect().right > innerWidth || b.getBoundingClientRect().bottom > innerHeight),
            };
          }),
        )
        .toEqual({ wide: false, view: true, canvas: true, panel: true, cut: false });
      const opener = page.getByRole('button', { name: width < 720 ? 'Details' : 'Panel' });
      if (width >= 960) continue;
      await opener.click();
      await page.locator('.panel, .scroll').first().waitFor();
      await drawn(page);
      const open = await page.evaluate(() => ['.view', '.panel, .scroll'].map((part) => document.querySelector(part)!.getBoundingClientRect().toJSON()));
      expect(open[0].height, 'the view stays where it is when the panel opens').toBeGreaterThan(0.25 * height);
      expect(open[0].width).toBeGreaterThan(0.9 * width);
      expect(open[1].right).toBeLessThanOrEqual(width);
      await opener.click();
    }
    await page.close();
  });

  test('pictures to look at: wide and phone, light and dark', async () => {
    const page = await browser.newPage({ viewport: { width: 1440, height: 900 }, reducedMotion: 'reduce' });
    await page.goto(`${site.url}?still=off`);
    await page.waitForFunction(() => window.topple?.loaded);
    await page.evaluate(() => {
      window.topple.seek(0.45 * window.topple.duration);
      window.topple.choose(6);
    });
    for (const [width, height] of [[1440, 900], [390, 844]]) {
      for (const colorScheme of ['light', 'dark'] as const) {
        await page.setViewportSize({ width, height });
        await page.emulateMedia({ colorScheme, reducedMotion: 'reduce' });
        await expect.poll(() => page.evaluate(() => document.documentElement.dataset.theme)).toBe(colorScheme);
        // The strip of time is drawn anew with the colours of the page, not with those that it had before.
        const isLight = (): Promise<boolean> => page.evaluate(() => {
          const strip = document.querySelector<HTMLCanvasElement>('.strip canvas')!.getContext('2d')!;
          return strip.getImageData(6, 10, 1, 1).data[0] > 128;
        });
        await expect.poll(isLight, { message: `${width} ${colorScheme}` }).toBe(colorScheme === 'light');
        await drawn(page);
        await page.screenshot({ path: `${kOut}/page-${width}-${colorScheme}.png` });
      }
    }
    await page.close();
  });
});
