/** Tools for structures, the brush, the push in the panel, slow motion, and what a growing run shows. */

import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, beforeEach, expect, test } from 'vitest';
import { arrived, drawn as twoFrames, launch, makeRecording, pauseAt, serve, toppled, type Site } from './browser.ts';

let browser: Browser;
let site: Site;
let page: Page;
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
  const context = await browser.newContext({ viewport: { width: 1000, height: 640 }, reducedMotion: 'reduce' });
  page = await context.newPage();
  page.on('console', (message) => message.type() === 'error' && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(error.message));
  await page.goto(`${site.url}?still=off`);
  await page.waitForFunction(() => window.topple?.mode === 'draw');
});

const text = (): Promise<string> => page.evaluate(() => window.topple.text);
const drawn = (): Promise<number> => page.evaluate(() => window.topple.drawn);
const settled = (): Promise<unknown> => page.waitForFunction(() => window.topple.settled && window.topple.drawn > 0);
const tool = (name: string): Promise<void> => page.getByRole('button', { name, exact: true }).click();
const pixel = async (x: number, y: number): Promise<{ x: number; y: number }> => (await page.evaluate(([a, b]) => window.topple.pixelAt(a, b), [x, y]))!;
async function drag(from: [number, number], to: [number, number]): Promise<void> {
  const [a, b] = [await pixel(...from), await pixel(...to)];
  await page.mouse.move(a.x, a.y);
  await page.mouse.down();
  await page.mouse.move((a.x + b.x) / 2, (a.y + b.y) / 2, { steps: 3 });
  await page.mouse.move(b.x, b.y, { steps: 3 });
  await page.mouse.up();
}

test('a wall runs across the way it falls, as long as it was drawn, and its panel makes it higher', async () => {
  await tool('Wall');
  await drag([-96, 0], [96, 0]); // four bricks of 48 mm
  await settled();
  expect(await text()).toMatch(/\[\[wall\]\][\s\S]*heading_deg = -90[\s\S]*count = 4\ncourses = 5/);
  // 4 + 5 + 4 + 5 + 4: every second course is closed by two halves.
  expect(await drawn()).toBe(22);
  await page.getByLabel('High').fill('2');
  await page.getByLabel('High').press('Enter');
  await expect.poll(drawn).toBe(9);
});

test('towers and pyramids stand where they are put', async () => {
  await tool('Tower');
  const at = await pixel(0, 0);
  await page.mouse.click(at.x, at.y);
  await settled();
  expect(await text()).toMatch(/\[\[tower\]\]\nat_mm = \[-?0(\.\d)?, -?0(\.\d)?\][\s\S]*layers = 8/);
  expect(await drawn()).toBe(16);
  await tool('Pyramid');
  await drag([100, 100], [244, 172]); // 3 × 48 mm by 3 × 24 mm
  await expect.poll(text).toMatch(/count_along = 3\ncount_across = 3/);
  await expect.poll(drawn).toBe(16 + 9 + 4 + 1);
  await page.keyboard.press('Control+z');
  await expect.poll(drawn).toBe(16);
});

test('a ball is drawn with its way and speed, brings no push along, and lets a row fall', async () => {
  await tool('Ball');
  await drag([-300, 0], [-100, 0]);
  await settled();
  expect(await text()).toMatch(/\[\[ball\]\][\s\S]*heading_deg = 0\nspeed_m_s = 1\n/);
  expect(await text()).not.toMatch(/\[\[push\]\]/);
  await tool('Row');
  await drag([-40, 0], [150, 0]);
  await expect.poll(drawn).toBeGreaterThan(5);
  await settled();
  expect(await page.evaluate(() => window.topple.doubts)).toEqual([]);
  await page.keyboard.press('Space');
  await toppled(page);
  await page.keyboard.press('End');
  await expect.poll(() => page.evaluate(() => window.topple.fallen)).toBeGreaterThan(5);
});

test('a stroke that begins at the end of a part goes on from it, a pitch further', async () => {
  await tool('Row');
  await drag([-300, 0], [-60, 0]); // 11 bricks; the last at -60 mm
  await settled();
  await tool('Wall');
  await drag([-58, 2], [-58, 98]);
  await expect.poll(text).toMatch(/\[\[wall\]\]\nat_mm = \[-\d+(\.\d)?, \d+(\.\d)?\]/);
  const [, x, y] = /\[\[wall\]\]\nat_mm = \[(-?[\d.]+), (-?[\d.]+)\]/.exec(await text())!.map(Number);
  // It starts at (-36, 0), 24 mm past the last brick; its middle is half its length on.
  expect(Math.hypot(x + 36, y)).toBeGreaterThan(40);
  expect(Math.abs(2 * x + 36 - -58)).toBeLessThan(30);
});

test('the brush colours single bricks, one stroke is one step of undo', async () => {
  await tool('Row');
  await drag([-150, 0], [150, 0]);
  await settled();
  const before = await text();
  await tool('Brush'); // nothing is chosen any more: the palette is the brush's
  await page.getByRole('button', { name: 'Teal', exact: true }).click();
  const at = async (brick: number): Promise<{ x: number; y: number }> => (await page.evaluate((b) => window.topple.placeOf(b), brick))!;
  const [a, b] = [await at(3), await at(5)];
  await page.mouse.move(a.x, a.y);
  await page.mouse.down();
  await page.mouse.move(b.x, b.y, { steps: 12 });
  await page.mouse.up();
  await expect.poll(text).toContain('paint = [[3, 5, "#17a398"]]');
  await settled();
  await expect.poll(() => page.getByLabel('Colours and kinds').innerText()).toMatch(/Teal\s*3/);
  await page.keyboard.press('Control+z');
  expect(await text()).toBe(before);
});

test('the push can be changed in the panel', async () => {
  await tool('Row');
  await drag([-150, 0], [150, 0]);
  await settled();
  await page.getByLabel('Brick that is pushed').fill('4');
  await page.getByLabel('Brick that is pushed').press('Enter');
  await page.getByLabel(/^How/).fill('2.5');
  await page.getByLabel(/^How/).press('Enter');
  await expect.poll(text).toMatch(/\[\[push\]\]\nbrick = 4\nangular_speed_rad_s = 2\.5/);
  await settled();
  expect(await page.evaluate(() => window.topple.doubts.join())).toMatch(/brick 0/); // nothing reaches it any more
});

/** A film of one picture: how many of its pixels have the blue of the floor's arrows, which nothing else here has. */
function filmColors(forces: boolean): Promise<number> {
  return page.evaluate(async (shown) => {
    const order = { format: 'webm', camera: 'front', width: 640, height: 360, fps: 10, speed: 1, from: 0.3, to: 0.4, sound: false, samples: 1, forces: shown } as const;
    const video = document.createElement('video');
    video.muted = true;
    video.src = URL.createObjectURL(new Blob([new Uint8Array(await window.topple.film(order))], { type: 'video/webm' }));
    await new Promise((ready, bad) => { video.onloadeddata = ready; video.onerror = bad; });
    video.currentTime = 0.01;
    await new Promise((ready) => (video.onseeked = ready));
    const sheet = new OffscreenCanvas(640, 360).getContext('2d')!;
    sheet.drawImage(video, 0, 0);
    const { data } = sheet.getImageData(0, 0, 640, 360);
    let found = 0;
    for (let i = 0; i < data.length; i += 4) if (data[i + 2] - data[i] > 30) found++;
    return found;
  }, forces);
}

test('forces at contacts are arrows: of all that moves, of the chosen brick, and a sentence where the model has none', async () => {
  await tool('Row');
  await drag([-150, 0], [150, 0]);
  await settled();
  await page.keyboard.press('Space');
  await toppled(page);
  await pauseAt(page, 0.3);
  await page.keyboard.press('f');
  const legend = page.locator('.legend');
  await expect.poll(() => legend.innerText()).toMatch(/brick on brick\s+floor on brick\s+strongest [\d.]+ N\s+a brick weighs 0\.08\d N/);
  const arrows = async (): Promise<number> => (await page.locator('path.head').evaluateAll((all) => all.map((one) => one.getAttribute('d') ?? '').join(''))).split('M').length - 1;
  await expect.poll(arrows).toBeGreaterThan(3);
  const all = await arrows();
  // In a film they are drawn into the pictures.
  const [bare, arrowed] = [await filmColors(false), await filmColors(true)];
  expect(bare).toBeLessThan(5);
  expect(arrowed).toBeGreaterThan(bare + 10);
  await page.evaluate(() => window.topple.choose(1));
  await expect.poll(async () => {
    const some = await arrows();
    return some > 0 && some < all;
  }).toBe(true);
  // Back before the first contact: the reel begins again where it must.
  await page.keyboard.press('Home');
  await expect.poll(() => legend.innerText()).toMatch(/nothing moves|strongest/);
  await page.keyboard.press('f');
  await expect.poll(() => legend.count()).toBe(0);
  const layout = '[[push]]\nangular_speed_rad_s = 6\n\n[[row]]\ncount = 4\ngap_mm = 16.5\n\n[model]\nname = "pivot"\n';
  await page.getByLabel('Layout or recording file').setInputFiles({ name: 'mine.toml', mimeType: 'application/toml', buffer: Buffer.from(layout) });
  await page.waitForFunction((wanted) => window.topple.text === wanted && window.topple.settled, layout);
  await page.locator('canvas').first().focus();
  await page.keyboard.press('Space');
  await toppled(page);
  await page.keyboard.press('f');
  const none = 'Pivot hands hits on and knows no forces between bricks that lean; hinge and rigid do.';
  await expect.poll(() => legend.innerText()).toBe(none);
  await expect(filmColors(true)).rejects.toThrow(none);
  await page.keyboard.press('f');
});

test('on Topple the camera comes nearer to a run that is small in the view, and for drawing it goes back', async () => {
  await tool('Row');
  await drag([-100, 0], [100, 0]);
  await settled();
  const breadth = (): Promise<number> =>
    page.evaluate(() => window.topple.placeOf(Math.max(0, window.topple.bricks - 1))!.x - window.topple.placeOf(0)!.x);
  const before = await breadth();
  await page.keyboard.press('Space');
  await expect.poll(breadth).toBeGreaterThan(1.5 * before);
  await toppled(page);
  await page.getByRole('button', { name: 'Draw', exact: true }).click();
  await expect.poll(async () => Math.abs((await breadth()) / before - 1)).toBeLessThan(0.02);
});

/** Where two bricks are in the page, to tell one camera from another. */
const places = (): Promise<string> => page.evaluate(() => [0, 5].map((brick) => Object.values(window.topple.placeOf(brick) ?? {}).map(Math.round).join()).join(' '));

test('every camera comes back to where it was: the table after the top, the free one after a brick’s eye, the table for drawing', async () => {
  await tool('Row');
  await drag([-250, 0], [250, 0]);
  await settled();
  const table = await places();
  await page.getByRole('button', { name: 'Top', exact: true }).click();
  await expect.poll(places).not.toBe(table);
  await page.getByRole('button', { name: 'Table' }).click();
  await expect.poll(places).toBe(table);
  await page.keyboard.press('Space');
  await toppled(page);
  await arrived(page);
  await pauseAt(page, 0); // where bricks are is told by what falls, too
  await page.keyboard.press('0'); // from the same side: brick 5 stays to the right of brick 0, as it was drawn
  await expect.poll(() => page.evaluate(() => window.topple.placeOf(5)!.x - window.topple.placeOf(0)!.x)).toBeGreaterThan(50);
  await twoFrames(page);
  const free = await places();
  for (const key of ['3', '4', '2']) {
    await page.keyboard.press(key);
    await expect.poll(places).not.toBe(free);
  }
  await page.keyboard.press('1');
  await expect.poll(places).toBe(free);
  await page.keyboard.press('2');
  await page.getByRole('button', { name: 'Draw', exact: true }).click();
  await expect.poll(places).toBe(table);
  await expect.poll(() => page.getByRole('button', { name: 'Table' }).getAttribute('aria-pressed')).toBe('true');
});

test('a run of many metres is a line in its colours while one draws, and its wave is ridden with when it falls', async () => {
  await page.getByLabel('Layout or recording file').setInputFiles({
    name: 'long.toml', mimeType: 'application/toml',
    buffer: Buffer.from('[[push]]\nangular_speed_rad_s = 4\n\n[[row]]\ncount = 5000\ngap_mm = 16.5\ncolor = "#d92b2b"\n\n[model]\nname = "hinge"\n'),
  });
  await settled();
  const ribbon = page.locator('[data-test=ribbon] polyline');
  await expect.poll(() => ribbon.count()).toBeGreaterThan(0);
  const ends = await ribbon.evaluateAll((all) => all.flatMap((one) => one.getAttribute('points')!.split(' ').map((point) => parseFloat(point))));
  expect(Math.max(...ends) - Math.min(...ends)).toBeGreaterThan(400); // from end to end of the view
  await page.locator('canvas').first().focus();
  await page.keyboard.press('Space');
  await toppled(page);
  await arrived(page);
  await expect.poll(() => page.getByRole('button', { name: 'Front', exact: true }).getAttribute('aria-pressed')).toBe('true');
  await expect.poll(() => ribbon.count()).toBe(0); // once the camera is near enough
  await page.getByRole('button', { name: 'Draw', exact: true }).click();
  await expect.poll(() => ribbon.count()).toBeGreaterThan(0);
});

test('why nothing can fall is said beside Topple, and leads to the warnings where they are out of sight', async () => {
  await page.setViewportSize({ width: 390, height: 844 });
  await page.getByLabel('Layout or recording file').setInputFiles({
    name: 'two.toml', mimeType: 'application/toml',
    buffer: Buffer.from('[[push]]\nangular_speed_rad_s = 4\n\n[[row]]\ncount = 9\ngap_mm = 16.5\n\n[[row]]\nfrom_mm = [50, 0]\ncount = 3\ngap_mm = 16.5\n'),
  });
  await settled();
  await expect.poll(() => page.getByRole('button', { name: 'Topple' }).isDisabled()).toBe(true);
  await expect.poll(() => page.getByRole('button', { name: 'Panel, 3 warnings' }).count()).toBe(1);
  await page.getByRole('button', { name: 'Bricks overlap' }).click();
  await expect.poll(() => page.getByLabel('Warnings', { exact: true }).innerText()).toMatch(/overlap by/);
  // What is said in the view does not stick out of it.
  await page.locator('.view .told').first().waitFor();
  await twoFrames(page);
  const boxes = await page.locator('.view .told').evaluateAll((all) => all.map((one) => one.getBoundingClientRect().toJSON() as DOMRect));
  expect(boxes.length).toBeGreaterThan(0);
  for (const box of boxes) expect([box.left >= 0, box.right <= 390]).toEqual([true, true]);
});

test('a wave that leaves bricks standing says how many, and where it came to', async () => {
  await page.getByLabel('Layout or recording file').setInputFiles({
    name: 'stops.toml', mimeType: 'application/toml',
    buffer: Buffer.from('[[push]]\nangular_speed_rad_s = 4\n\n[[row]]\ncount = 5\ngap_mm = 16.5\n\n[[row]]\nfrom_mm = [300, 0]\ncount = 3\ngap_mm = 16.5\n\n[model]\nname = "rigid"\n'),
  });
  await settled();
  await page.locator('canvas').first().focus();
  await page.keyboard.press('Space');
  await toppled(page);
  const panel = page.getByRole('complementary');
  await expect.poll(() => panel.innerText()).toMatch(/8, of which 5 fall\s+Standing\s+3; the wave came as far as brick 4/);
  await expect.poll(() => panel.innerText()).toMatch(/End\s+At [\d.]+ s everything is at rest\./);
  await panel.getByRole('button', { name: 'Brick 4' }).click();
  await expect.poll(() => page.evaluate(() => window.topple.chosen)).toBe(4);
});

test('without a pointer: a row is put down, goes on in a curve, is toppled and looked at', async () => {
  await page.locator('canvas').first().focus();
  await page.keyboard.press('r');
  await page.keyboard.press('Enter');
  await settled();
  const row = await drawn();
  expect(row).toBe(13); // 300 mm at a pitch of 24 mm
  await page.keyboard.press('c');
  await page.keyboard.press('Enter');
  await expect.poll(drawn).toBeGreaterThan(row + 8);
  await settled();
  expect(await page.evaluate(() => window.topple.doubts)).toEqual([]);
  await page.keyboard.press('Space');
  await toppled(page);
  await page.keyboard.press('End');
  await expect.poll(() => page.evaluate(() => window.topple.fallen === window.topple.bricks)).toBe(true);
});

test('a model that cannot run a layout says so beside Topple, and another one is a click away', async () => {
  await page.getByLabel('Layout or recording file').setInputFiles({
    name: 'bend.toml', mimeType: 'application/toml',
    buffer: Buffer.from('[[push]]\nangular_speed_rad_s = 4\n\n[[curve]]\npoints_mm = [[0, 0], [100, 0], [140, 60], [140, 160]]\ngap_mm = 16.5\n\n[model]\nname = "hinge"\n'),
  });
  await settled();
  await page.locator('canvas').first().focus();
  await page.keyboard.press('Space');
  await page.getByLabel('Run').getByText('Hinge cannot run this').waitFor();
  await page.getByRole('button', { name: 'Use rigid' }).click();
  await settled();
  await expect.poll(() => page.getByRole('button', { name: 'Topple' }).isEnabled()).toBe(true);
  expect(await text()).toMatch(/name = "rigid"/);
});

test('the gap has builders’ usual one beside it, and a click takes it', async () => {
  await tool('Row');
  await drag([-150, 0], [150, 0]);
  await settled();
  await page.getByRole('button', { name: '7.5 mm', exact: true }).click();
  await expect.poll(() => page.getByLabel('Gap', { exact: true }).inputValue()).toBe('7.5');
  expect(await text()).toMatch(/gap_mm = 7\.5/);
});

test('what the browser cannot keep is said at any size, and a menu closes when one touches elsewhere', async () => {
  await page.setViewportSize({ width: 390, height: 844 });
  await page.getByRole('button', { name: 'More' }).click();
  expect(await page.getByRole('button', { name: 'Scenes' }).isVisible()).toBe(true);
  await page.mouse.click(60, 400);
  await expect.poll(() => page.getByRole('button', { name: 'Scenes' }).isVisible()).toBe(false);
  await page.evaluate(() => {
    Storage.prototype.setItem = () => {
      throw new DOMException('full', 'QuotaExceededError');
    };
  });
  await tool('Row');
  const said = page.getByRole('status').filter({ hasText: 'too large for this browser to keep: save it as a file' }).waitFor(); // it is there for a while only
  await drag([-100, 0], [100, 0]);
  await said;
});

test('a colour for all goes to each part that knows it: a ball and a single brick have one, and no kind', async () => {
  await tool('Row');
  await drag([-150, 0], [150, 0]);
  await tool('Brick');
  const at = await pixel(-200, -150);
  await page.mouse.click(at.x, at.y);
  await tool('Ball');
  await drag([-300, 100], [-250, 100]);
  await expect.poll(text).toMatch(/\[\[ball\]\]/);
  await settled();
  await expect.poll(async () => [await page.getByLabel('Kind', { exact: true }).count(), await page.getByLabel('Colour of the last brick').count()]).toEqual([0, 0]);
  await page.locator('canvas').first().focus();
  await page.keyboard.press('Control+a');
  await page.getByLabel('Colour of the last brick').fill('#17a398');
  await settled();
  expect((await text()).match(/color_to = "#17a398"/g)?.length).toBe(1);
  expect(await page.getByLabel('Warnings', { exact: true }).innerText()).not.toMatch(/unknown key/);
});

test('slow motion goes round the cursor, and back to what it was', async () => {
  await tool('Row');
  await drag([-250, 0], [250, 0]);
  await settled();
  await page.keyboard.press('Space');
  await toppled(page);
  await pauseAt(page, 0.5);
  await page.keyboard.press('s');
  const slow = page.getByRole('button', { name: 'Slow motion' });
  await expect.poll(() => slow.getAttribute('aria-pressed')).toBe('true');
  await expect.poll(() => page.locator('.transport output').innerText()).toBe('1/10×');
  // Every picture until it begins anew: 0.1 s before the cursor to 0.2 s after it.
  const times = await page.evaluate(() => new Promise<number[]>((done) => {
    const seen = [window.topple.time];
    requestAnimationFrame(function look() {
      seen.push(window.topple.time);
      if (seen[seen.length - 1] < seen[seen.length - 2]) done(seen);
      else requestAnimationFrame(look);
    });
  }));
  expect(Math.min(...times)).toBeGreaterThanOrEqual(0.399);
  expect(Math.max(...times)).toBeLessThanOrEqual(0.701);
  await page.keyboard.press('s');
  await expect.poll(() => slow.getAttribute('aria-pressed')).toBe('false');
  await expect.poll(() => page.locator('.transport output').innerText()).toBe('1×');
  await expect.poll(() => page.locator('.range').count()).toBe(0);
});

test('while a run goes on, what is not simulated yet is hatched', async () => {
  await page.getByLabel('Layout or recording file').setInputFiles({
    name: 'long.toml', mimeType: 'application/toml',
    buffer: Buffer.from('[[push]]\nangular_speed_rad_s = 4\n\n[[row]]\ncount = 20000\ngap_mm = 16.5\n\n[model]\nname = "hinge"\n'),
  });
  await settled();
  await page.locator('canvas').first().focus();
  // The run may be over before one could look: what the page puts up is watched.
  await page.evaluate(() => {
    const seen = { hatched: 0 };
    Object.assign(window, { seen });
    new MutationObserver(() => (seen.hatched += document.querySelectorAll('[data-test=unknown]').length)).observe(document.body, { childList: true, subtree: true });
  });
  await page.keyboard.press('Space');
  await toppled(page);
  expect(await page.evaluate(() => (window as never as { seen: { hatched: number } }).seen.hatched)).toBeGreaterThan(0);
  await expect.poll(() => page.locator('[data-test=unknown]').count()).toBe(0);
});

/** A ball that nothing slows down rolls for ever: no machine is so quick that the run would end by itself. */
const kEndless = `[[push]]
angular_speed_rad_s = 4

[[row]]
count = 60
gap_mm = 16.5

[[ball]]
at_mm = [0, 500]
heading_deg = 90
speed_m_s = 0.1
rolling_friction = 0

[model]
name = "rigid"
time_step_s = 0.000001
`;

test('a run can be stopped while one watches, and what was simulated stays', async () => {
  await page.getByLabel('Layout or recording file').setInputFiles({ name: 'long.toml', mimeType: 'application/toml', buffer: Buffer.from(kEndless) });
  await settled();
  await page.locator('canvas').first().focus();
  await page.keyboard.press('Space');
  await page.locator('.running').waitFor();
  await expect.poll(() => page.getByRole('complementary').innerText()).toMatch(/fall so far[\s\S]*still being simulated/);
  await page.locator('.running').getByRole('button', { name: 'Stop' }).click();
  await expect.poll(() => page.getByRole('complementary').innerText()).toMatch(/the run was stopped/i);
  await expect.poll(() => page.locator('.running').count()).toBe(0);
  await expect.poll(() => page.evaluate(() => window.topple.duration)).toBeGreaterThan(0);
});

test('a recording that is opened while a run goes on stays: the run is stopped and not shown over it', async () => {
  await page.getByLabel('Layout or recording file').setInputFiles({ name: 'long.toml', mimeType: 'application/toml', buffer: Buffer.from(kEndless) });
  await settled();
  await page.locator('canvas').first().focus();
  await page.keyboard.press('Space');
  await expect.poll(() => page.evaluate(() => window.topple.duration)).toBeGreaterThan(0);
  await page.getByLabel('Layout or recording file').setInputFiles({ name: 'seven.topple', mimeType: 'application/octet-stream', buffer: Buffer.from(makeRecording({ count: 7 })) });
  await expect.poll(() => page.evaluate(() => window.topple.bricks)).toBe(7);
  await expect.poll(() => page.locator('[data-test=unknown]').count()).toBe(0);
  // The engine takes the next order once it has let go of that run.
  const short = '[[push]]\nangular_speed_rad_s = 4\n\n[[row]]\ncount = 3\ngap_mm = 16.5\n\n[model]\nname = "hinge"\n';
  expect(await page.evaluate((text) => window.topple.runHash(text), short)).toMatch(/^[0-9a-f]{16}$/);
  expect(await page.evaluate(() => window.topple.bricks)).toBe(7);
});

test('a run that is refused leaves the camera where one drew', async () => {
  const bend = '[[push]]\nangular_speed_rad_s = 4\n\n[[curve]]\npoints_mm = [[0, 0], [100, 0], [140, 60], [140, 160]]\ngap_mm = 16.5\n\n[model]\nname = "hinge"\n';
  await page.getByLabel('Layout or recording file').setInputFiles({ name: 'bend.toml', mimeType: 'application/toml', buffer: Buffer.from(bend) });
  await settled();
  await page.evaluate(() => window.topple.lookFrom([0.1, -1.8, 2], [0.1, 0.1, 0])); // from where the run would be small
  await twoFrames(page);
  const table = await places();
  await page.locator('canvas').first().focus();
  // No frame comes before the engine has answered, as on a machine that draws slowly.
  await page.evaluate(() => {
    const [ask, held] = [window.requestAnimationFrame.bind(window), [] as FrameRequestCallback[]];
    window.requestAnimationFrame = (draw) => held.push(draw);
    const letGo = (): void => {
      window.requestAnimationFrame = ask;
      held.forEach((draw) => ask(draw));
    };
    Object.assign(window, { letGo });
  });
  await page.keyboard.press('Space');
  await page.getByLabel('Run').getByText('Hinge cannot run this').waitFor();
  await page.evaluate(() => (window as never as { letGo: () => void }).letGo());
  await arrived(page);
  await twoFrames(page);
  expect(await places()).toBe(table);
});

test('nothing was reported as an error', () => expect(complaints).toEqual([]));
