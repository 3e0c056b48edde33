/** The page in a real browser: loading, playing, scrubbing, picking, keys. */

import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { drawn as twoFrames, launch, makeRecording, recordingOf, serve, type Site } from './browser.ts';

const kLayout = 'studio/tests/page/row.toml';
let browser: Browser;
let site: Site;
let page: Page;
/** Made by the program. */
let real = false;
const complaints: string[] = [];

beforeAll(async () => {
  const { bytes, real: made } = await recordingOf(kLayout, () => makeRecording({ count: 12 }));
  real = made;
  site = await serve(bytes, { front_speed_m_s: 0.9, end: 'at rest' });
  browser = await launch();
  page = await browser.newPage({ viewport: { width: 1000, height: 560 }, reducedMotion: 'reduce' });
  page.on('console', (message) => message.type() === 'error' && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(error.message));
  await page.goto(`${site.url}?still=off`);
  await page.waitForFunction(() => window.topple?.loaded);
});
afterAll(async () => {
  await browser?.close();
  await site?.close();
});

/** What the page draws and what the recording says, for every brick. */
function tilts(): Promise<{ drawn: number; recorded: number }[]> {
  return page.evaluate(() =>
    Array.from({ length: window.topple.bricks }, (_, brick) => ({ drawn: window.topple.drawnTilt(brick), recorded: window.topple.tilt(brick) })),
  );
}
const time = (): Promise<number> => page.evaluate(() => window.topple.time);
const duration = (): Promise<number> => page.evaluate(() => window.topple.duration);
const drawn = (): Promise<void> => twoFrames(page);
const chosen = (): Promise<number> => page.evaluate(() => window.topple.chosen);
/** How far the brick that is farthest from standing is tilted where it is drawn [rad]. */
const mostTilt = async (): Promise<number> => Math.max(...(await tilts()).map((one) => one.drawn));

describe('the page', () => {
  test('names the run and shows its numbers', async () => {
    await expect.poll(() => page.title()).toMatch(/ – Topple$/);
    await expect.poll(() => page.getByRole('heading', { level: 1 }).innerText()).toMatch(/12 bricks/);
    await expect.poll(() => page.locator('[data-test=read-out]').innerText()).toMatch(/0\.000 s[\s\S]*0 \/ 12[\s\S]*–/);
  });

  test('all bricks stand at the start', async () => {
    await expect.poll(mostTilt).toBeLessThan(1e-6);
  });

  test('plays to the end, where every brick leans or lies as the recording says', async () => {
    await page.evaluate(() => document.body.focus());
    for (let i = 0; i < 6; i++) await page.keyboard.press(']');
    await page.keyboard.press('Space');
    await page.waitForFunction(() => window.topple.time === window.topple.duration && !window.topple.playing);
    await drawn();
    const all = await tilts();
    for (const { drawn: tilt, recorded } of all) expect(tilt).toBeCloseTo(recorded, 5);
    expect(all[11].drawn).toBeCloseTo(Math.PI / 2, 3); // the last lies flat
    for (const { drawn: tilt } of all.slice(0, 11)) {
      // All others lean on the next, past their tip angle and short of flat: atan(7.5 / 48) = 8.9 degrees.
      expect(tilt).toBeGreaterThan(0.16);
      expect(tilt).toBeLessThan(Math.PI / 2);
    }
    await expect.poll(() => page.evaluate(() => window.topple.fallen)).toBe(12);
    await expect.poll(() => page.locator('[data-test=read-out]').innerText()).toMatch(/12 \/ 12[\s\S]*–/);
  });

  test('scrubs back to zero, and all stand', async () => {
    const strip = page.getByRole('slider', { name: 'Time' });
    const box = (await strip.boundingBox())!;
    await page.mouse.move(box.x + box.width - 4, box.y + 10);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2, box.y + 10, { steps: 3 });
    await expect.poll(async () => Math.abs((await time()) / (await duration()) - 0.5)).toBeLessThan(0.2);
    await page.mouse.move(box.x - 40, box.y + 10, { steps: 3 });
    await page.mouse.up();
    await expect.poll(time).toBe(0);
    await expect.poll(mostTilt).toBeLessThan(1e-6);
  });

  test('a click chooses the brick that is drawn there, and the panel tells its story', async () => {
    await page.evaluate(() => window.topple.lookFrom([0.2, -0.6, 0.25], [0.13, 0, 0.02]));
    await drawn();
    const at = (await page.evaluate(() => window.topple.placeOf(6)))!;
    await expect.poll(() => isColorful(at.x, at.y)).toBe(true);
    await page.mouse.click(at.x, at.y);
    await expect.poll(chosen).toBe(6);
    const panel = page.getByRole('complementary');
    await expect.poll(() => panel.innerText()).toMatch(/Brick 6[\s\S]*mm[\s\S]*Struck by[\s\S]*5[\s\S]*at [\d.]+ s[\s\S]*Strikes[\s\S]*7[\s\S]*standing/);
    await panel.getByRole('button', { name: 'Brick 5' }).click();
    await expect.poll(chosen).toBe(5);
    await expect.poll(() => panel.locator('.u-wrap canvas').count()).toBe(3);
  });

  test('a click on the bare table chooses none', async () => {
    const box = (await page.locator('.view canvas').boundingBox())!;
    await page.mouse.click(box.x + 20, box.y + box.height - 20);
    await expect.poll(chosen).toBe(-1);
  });

  test('every key does what the list says', async () => {
    const press = async (...keys: string[]): Promise<void> => {
      for (const key of keys) await page.keyboard.press(key);
    };
    await press('End');
    expect(await time()).toBe(await duration());
    await press('Home');
    expect(await time()).toBe(0);
    await press('\\', 'ArrowRight');
    expect(await time()).toBeCloseTo(1 / 60, 6);
    await press('Shift+ArrowRight');
    expect(await time()).toBeCloseTo(11 / 60, 6);
    await press('[', 'ArrowLeft'); // a quarter
    expect(await time()).toBeCloseTo(11 / 60 - 1 / 240, 6);
    await press('Home', 'ArrowDown');
    const first = await time();
    expect(first).toBeGreaterThan(0);
    await press('ArrowDown', 'ArrowUp');
    expect(await time()).toBeCloseTo(first, 9);
    await press('n', 'n');
    const second = await chosen();
    await press('Shift+N');
    expect(await chosen()).toBe(second - 1);
    await press('Escape');
    expect(await chosen()).toBe(-1);
    const pressed = (name: string): Promise<string | null> => page.getByRole('button', { name, exact: true }).getAttribute('aria-pressed');
    for (const [key, name] of [['2', 'Front'], ['3', 'Brick’s eye'], ['4', 'Top'], ['1', 'Orbit']]) {
      await press(key);
      await expect.poll(() => pressed(name)).toBe('true');
    }
    await press('0', 'h', 'h', 'l');
    await expect.poll(() => pressed('Loop')).toBe('true');
    await press('l', '?');
    await expect.poll(() => page.getByRole('dialog').innerText()).toMatch(/Play or pause/);
    await press('Escape');
    await expect.poll(() => page.getByRole('dialog').count()).toBe(0);
  });

  test('measures what lies between two bricks on the table', async () => {
    await page.evaluate(() => {
      window.topple.seek(0);
      window.topple.lookFrom([0.13, -0.5, 0.4], [0.13, 0, 0]);
    });
    await page.keyboard.press('g');
    await drawn();
    await page.keyboard.press('m');
    const box = (await page.locator('.view canvas').boundingBox())!;
    // From the middle of the picture, which is the place looked at, to a place on its right: the same height in the picture.
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await page.mouse.click(x, y);
    await page.mouse.click(x + 100, y);
    // The camera is 0.6403 m away with a field of 30 degrees over the height: 100 pixels are 100 / height x 2 tan(15 deg) x 0.6403 m.
    const expected = (100 / box.height) * 2 * Math.tan(Math.PI / 12) * Math.hypot(0.5, 0.4) * 1000;
    await expect.poll(async () => parseFloat(await page.locator('.told[role=status]').innerText())).toBeCloseTo(expected, 0);
    await page.keyboard.press('Escape');
    await page.keyboard.press('g');
    await expect.poll(() => page.locator('.told[role=status]').count()).toBe(0);
  });

  test('saves the view as a PNG picture', async () => {
    const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Picture' }).click()]);
    expect(download.suggestedFilename()).toMatch(/s\.png$/);
    const stream = await download.createReadStream();
    const head = await new Promise<Buffer>((done) => stream.once('data', (bytes: Buffer) => done(bytes)));
    expect(head.subarray(1, 4).toString()).toBe('PNG');
  });

  test('a still is averaged where it stood', async () => {
    await page.evaluate(() => window.topple.finishStill(3));
    const at = (await page.evaluate(() => window.topple.placeOf(6)))!;
    await expect.poll(() => isColorful(at.x, at.y)).toBe(true);
  });

  test('a recording from elsewhere is compared by its own layout, and is still there afterwards', async () => {
    if (!real) return; // one that is made up holds no layout
    await page.getByRole('button', { name: 'Compare' }).click();
    await expect.poll(() => page.getByRole('article', { name: 'Rigid' }).innerText()).toMatch(/Fallen\s+12 of 12/);
    await page.getByRole('button', { name: 'Watch' }).click();
    await page.keyboard.press('End');
    await expect.poll(() => page.evaluate(() => window.topple.fallen)).toBe(12);
  });

  test('nothing was reported as an error', () => {
    expect(complaints).toEqual([]);
  });
});

/** Whether the page shows a colour there rather than the table's grey. */
async function isColorful(x: number, y: number): Promise<boolean> {
  const shot = await page.screenshot({ clip: { x: x - 2, y: y - 2, width: 4, height: 4 } });
  return page.evaluate(async (base64) => {
    const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${base64}`)).blob());
    const pen = new OffscreenCanvas(4, 4).getContext('2d')!;
    pen.drawImage(bitmap, 0, 0);
    const [r, g, b] = pen.getImageData(1, 1, 1, 1).data;
    return Math.max(r, g, b) - Math.min(r, g, b) > 60;
  }, shot.toString('base64'));
}
