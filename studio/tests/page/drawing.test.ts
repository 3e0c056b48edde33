/** As a new user would: from an empty page to a shared film of an S-curve with a split; and that nothing drawn is ever lost. */

import { createRequire } from 'node:module';
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync } from 'node:fs';
import { mkdir, mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Browser, BrowserContext, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { kGallery } from '../../src/draw/gallery.ts';
import { makeFragment } from '../../src/draw/link.ts';
import { arrived, drawn as drawnIn, kOut, kProgram, kRoot, launch, pauseAt, serve, serveFolder, toppled, type Site } from './browser.ts';

const kAxe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const golden = readFileSync(join(kRoot, 'tests/golden/hashes.txt'), 'utf8').split('\n').filter((line) => line && !line.startsWith('#')).map((line) => line.split(' '));

let browser: Browser;
let site: Site;
let context: BrowserContext;
let page: Page;
let link = '';
const complaints: string[] = [];

function listen(to: Page): Page {
  to.on('console', (message) => message.type() === 'error' && complaints.push(message.text()));
  to.on('pageerror', (error) => complaints.push(error.message));
  return to;
}
async function open(address = ''): Promise<Page> {
  const opened = listen(await context.newPage());
  await opened.goto(`${site.url}?still=off${address}`);
  await opened.waitForFunction(() => window.topple?.mode === 'draw');
  return opened;
}
beforeAll(async () => {
  site = await serve(null);
  browser = await launch();
  await mkdir(kOut, { recursive: true });
  context = await browser.newContext({ viewport: { width: 1000, height: 640 }, reducedMotion: 'reduce', acceptDownloads: true });
  page = await open();
});
afterAll(async () => {
  await browser?.close();
  await site?.close();
});

const drawn = (): Promise<number> => page.evaluate(() => window.topple.drawn);
const text = (): Promise<string> => page.evaluate(() => window.topple.text);
/** Drags from one place of the table to another [mm]. */
async function drag(from: [number, number], to: [number, number]): Promise<void> {
  const at = async ([x, y]: [number, number]): Promise<[number, number]> => {
    const place = (await page.evaluate(([a, b]) => window.topple.pixelAt(a, b), [x, y]))!;
    return [place.x, place.y];
  };
  await page.mouse.move(...(await at(from)));
  await page.mouse.down();
  await page.mouse.move(...(await at([(from[0] + to[0]) / 2, (from[1] + to[1]) / 2])), { steps: 3 });
  await page.mouse.move(...(await at(to)), { steps: 3 });
  await page.mouse.up();
}
const tool = (name: string): Promise<void> => page.getByRole('button', { name, exact: true }).click();
/** Until the engine has answered to the text as it is now. */
const settled = (of = page): Promise<unknown> => of.waitForFunction(() => window.topple.settled);
async function axe(of: Page): Promise<string[]> {
  await of.evaluate(kAxe);
  const found = await of.evaluate(async () => (await (window as never as { axe: { run: () => Promise<{ violations: { id: string; impact: string; nodes: { html: string }[] }[] }> } }).axe.run()).violations);
  return found.filter((one) => one.impact === 'serious' || one.impact === 'critical').map((one) => `${one.id}: ${one.nodes[0].html.slice(0, 160)}`);
}

describe('an empty page', () => {
  test('"Draw a line": a drag at once is one, with no tool chosen before', async () => {
    const other = await browser.newContext({ viewport: { width: 1100, height: 640 }, reducedMotion: 'reduce' });
    const one = listen(await other.newPage());
    await one.goto(`${site.url}?still=off`);
    await one.waitForFunction(() => window.topple?.mode === 'draw');
    await one.mouse.move(300, 300);
    await one.mouse.down();
    await one.mouse.move(600, 320, { steps: 6 });
    await one.mouse.up();
    await expect.poll(() => one.evaluate(() => window.topple.drawn)).toBeGreaterThan(5);
    // What somebody has of a colour is kept beside the layout, and said where it is too little.
    await one.getByLabel('Red available').fill('3');
    await one.getByLabel('Red available').press('Enter');
    await expect.poll(() => one.getByRole('status').filter({ hasText: 'missing' }).innerText()).toMatch(/^Red: \d+ used, 3 available\. \d+ are missing\.$/);
    await one.reload();
    await one.waitForFunction(() => window.topple?.drawn > 5);
    await expect.poll(() => one.getByLabel('Red available').inputValue()).toBe('3');
    await one.getByLabel('Red available').fill('');
    await one.getByLabel('Red available').press('Enter');
    await expect.poll(() => one.getByText('missing').count()).toBe(0);
    await other.close();
  });

  test('three scenes can be opened at once', async () => {
    const other = await browser.newContext({ viewport: { width: 900, height: 600 }, reducedMotion: 'reduce' });
    const one = listen(await other.newPage());
    await one.goto(`${site.url}?still=off`);
    await one.getByRole('button', { name: 'A spiral', exact: true }).click();
    await expect.poll(() => one.evaluate(() => window.topple.drawn)).toBeGreaterThan(50);
    await expect.poll(() => one.getByRole('button', { name: 'Select', exact: true }).getAttribute('aria-pressed')).toBe('true');
    await other.close();
  });
});

describe('a new user', () => {
  test('draws an S by mouse: bricks stand along it, one is pushed', async () => {
    await tool('S');
    await drag([-450, 0], [250, 0]);
    await expect.poll(drawn).toBeGreaterThan(25);
    expect(await text()).toMatch(/\[\[push\]\]\nbrick = 0[\s\S]*\[\[curve\]\][\s\S]*gap_mm = 16\.5/);
  });

  test('lets it split, and no warning is left', async () => {
    const before = await drawn();
    await tool('Split');
    const end = (await page.evaluate(() => window.topple.pixelAt(243, -4)))!;
    await page.mouse.click(end.x, end.y);
    await expect.poll(drawn).toBeGreaterThan(before + 20);
    await expect.poll(() => page.evaluate(() => window.topple.doubts)).toEqual([]);
  });

  test('changes a gap, which the file says; undo and redo go all the way', async () => {
    const first = await text();
    await page.keyboard.press('v');
    await page.keyboard.press('n');
    const gap = page.getByLabel('Gap', { exact: true });
    await gap.fill('0.5 in');
    await gap.press('Enter');
    await expect.poll(text).toContain('gap_mm = 12.7');
    await page.locator('canvas').first().focus();
    await page.keyboard.press('Control+z');
    await expect.poll(text).toBe(first);
    for (let i = 0; i < 5; i++) await page.keyboard.press('Control+z');
    expect(await page.evaluate(() => window.topple.text)).not.toContain('[[curve]]');
    for (let i = 0; i < 5; i++) await page.keyboard.press('Control+Shift+z');
    await expect.poll(text).toContain('12.7');
    await page.keyboard.press('Control+z');
    await expect.poll(text).toBe(first);
  });

  test('moves, turns, mirrors, duplicates and deletes by keys', async () => {
    const first = await text();
    const parts = (file: string): number => (file.match(/\[\[curve\]\]/g) ?? []).length;
    await expect.poll(drawn).toBeGreaterThan(40);
    await page.keyboard.press('Escape');
    await page.keyboard.press('n');
    for (const key of ['ArrowRight', 'q', 'x']) await page.keyboard.press(key);
    expect(await text()).not.toBe(first);
    await page.keyboard.press('Control+d');
    expect(parts(await text())).toBe(parts(first) + 1);
    await page.keyboard.press('Delete');
    expect(parts(await text())).toBe(parts(first));
    for (let i = 0; i < 12 && (await text()) !== first; i++) await page.keyboard.press('Control+z');
    expect(await text()).toBe(first);
  });

  test('sees a warning where the wave stops, and is led there', async () => {
    const first = await text();
    await tool('Brick');
    const far = (await page.evaluate(() => window.topple.pixelAt(-300, -250)))!;
    await page.mouse.click(far.x, far.y);
    await expect.poll(() => page.evaluate(() => window.topple.doubts.join())).toMatch(/No brick near brick \d+ \(part: brick 1\) falls towards it/);
    await page.getByRole('button', { name: 'Show' }).click();
    await page.screenshot({ path: `${kOut}/studio-warning.png` });
    await page.locator('canvas').first().focus();
    await page.keyboard.press('Control+z');
    await expect.poll(text).toBe(first);
    await page.keyboard.press('0');
  });

  test('topples it with the space bar: all fall, and the hash is that of the program', async () => {
    await expect.poll(() => page.evaluate(() => window.topple.doubts)).toEqual([]);
    await page.keyboard.press('Space');
    await toppled(page);
    await expect.poll(() => page.evaluate(() => window.topple.mode)).toBe('watch');
    await page.keyboard.press('End');
    await expect.poll(() => page.evaluate(() => window.topple.fallen === window.topple.bricks)).toBe(true);
    if (!existsSync(kProgram)) return;
    const folder = await mkdtemp(join(tmpdir(), 'topple drawn '));
    await writeFile(join(folder, 'drawn.toml'), await text());
    const native = JSON.parse(execFileSync(kProgram, ['run', join(folder, 'drawn.toml'), '--json'], { encoding: 'utf8' })) as { hash: string };
    await rm(folder, { recursive: true });
    expect(native.hash).toBe(await page.evaluate(() => window.topple.hash));
  });

  test('hears the hits once the sound is on, in slow motion too', async () => {
    await page.getByRole('button', { name: 'Sound' }).click();
    await page.locator('canvas').first().focus();
    await pauseAt(page, 0);
    await page.keyboard.press('[');
    await page.keyboard.press('Space');
    await expect.poll(() => page.evaluate(() => window.topple.clicks)).toBeGreaterThan(2);
    await pauseAt(page, 0);
    await page.getByRole('button', { name: 'Sound' }).click();
  });

  test('looks at it with arrows, trace, heat and ghost', async () => {
    for (const name of ['Hits', 'Trace', 'Ghost']) await page.getByRole('button', { name, exact: true }).click();
    for (const heat of ['arrival', 'speed', 'impulse', '']) await page.locator('#heat').selectOption(heat);
    await page.evaluate(() => window.topple.seek(0.5 * window.topple.duration));
    await expect.poll(() => page.locator('path.way').count()).toBe(1);
    for (const name of ['Hits', 'Trace', 'Ghost']) await page.getByRole('button', { name, exact: true }).click();
  });

  test('makes a film, frame by frame, that another program can read', async () => {
    const film = await page.evaluate(async () => {
      const bytes = await window.topple.film({ format: 'webm', camera: 'front', width: 160, height: 90, fps: 10, speed: 1, from: 0, to: 0.6, sound: true, samples: 1 });
      return Array.from(bytes);
    });
    expect(film.slice(0, 4)).toEqual([0x1a, 0x45, 0xdf, 0xa3]); // EBML: WebM
    const seconds = await page.evaluate(async (bytes) => {
      const video = document.createElement('video');
      video.src = URL.createObjectURL(new Blob([new Uint8Array(bytes)], { type: 'video/webm' }));
      await new Promise((ready, bad) => { video.onloadedmetadata = ready; video.onerror = bad; });
      return [video.duration, video.videoWidth, video.videoHeight];
    }, film);
    expect(Math.abs(seconds[0] - 0.63)).toBeLessThan(0.06); // the last click rings out
    expect(seconds.slice(1)).toEqual([160, 90]);
  });

  test('compares three models side by side', async () => {
    await page.getByRole('button', { name: 'Compare' }).click();
    const rigid = page.getByRole('article', { name: 'Rigid' });
    await expect.poll(() => rigid.innerText()).toMatch(/Front speed\s+[\d.]+ m\/s[\s\S]*Hash/);
    // Each of the three views shows its model's bricks at the one time: what has fallen differs from what stands.
    const views = page.locator('.views');
    const box = (await views.boundingBox())!;
    const colorful = (): Promise<number[]> => colorsIn(page, box, 3);
    await expect.poll(async () => Math.min(...(await colorful()))).toBeGreaterThan(20);
    await page.getByLabel('Time').fill('0.6');
    await expect.poll(() => views.innerText()).toMatch(/Rigid\s+[1-9]\d* of/);
    // One camera for all: turned in one view, every view turns.
    const third = (): Promise<Buffer> => page.screenshot({ clip: { ...box, x: box.x + (2 * box.width) / 3, width: box.width / 3 } });
    let before = await third();
    await expect.poll(async () => before.equals((before = await third()))).toBe(true); // the picture of that time is there
    await page.mouse.move(box.x + 60, box.y + 120);
    await page.mouse.down();
    await page.mouse.move(box.x + 160, box.y + 110, { steps: 3 });
    await page.mouse.up();
    await expect.poll(async () => before.equals(await third())).toBe(false);
    await page.keyboard.press('End');
    await page.getByRole('button', { name: 'Play all three' }).click();
    await page.getByRole('button', { name: 'Draw', exact: true }).click();
  });

  test('shares it: the same hash in another profile, said in words', async () => {
    await page.getByRole('button', { name: 'Copy link' }).click();
    await expect.poll(() => page.evaluate(() => location.hash)).toMatch(/^#layout=[\w-]+&hash=[0-9a-f]{16}$/);
    link = await page.evaluate(() => location.hash);
    const other = await browser.newContext({ viewport: { width: 700, height: 500 }, reducedMotion: 'reduce' });
    const friend = listen(await other.newPage());
    await friend.goto(`${site.url}?still=off${link}`);
    await friend.waitForFunction((mine) => window.topple?.text === mine && window.topple.settled, await text());
    const note = friend.getByText(/Same result as the sender’s \(hash [0-9a-f ]+\)/).waitFor();
    await friend.keyboard.press('Space');
    await toppled(friend);
    expect(link.endsWith(await friend.evaluate(() => window.topple.hash))).toBe(true);
    await note;
    await other.close();
  });

  test('a link whose hash is another one says both', async () => {
    const other = await browser.newContext({ viewport: { width: 700, height: 500 }, reducedMotion: 'reduce' });
    const friend = listen(await other.newPage());
    await friend.goto(`${site.url}?still=off${link.slice(0, -4)}0000`);
    await friend.waitForFunction(() => window.topple?.drawn > 0 && window.topple.settled);
    const note = friend.getByText(/The sender’s result was another one: hash [0-9a-f ]+ there, [0-9a-f ]+ here/).waitFor();
    await friend.keyboard.press('Space');
    await note;
    await other.close();
  });

  test('a link whose layout is none says every problem and loses nothing', async () => {
    const mine = await text();
    const opened = await open(await makeFragment({ text: '[[row]]\ncount = 0\ngap_mm = 10\n', hash: '' }));
    await expect.poll(() => opened.getByRole('alert').innerText()).toMatch(/The layout in this link cannot be opened\.[\s\S]*count: must be[\s\S]*untouched/);
    await expect.poll(() => opened.evaluate(() => window.topple.text)).toBe(mine);
    await opened.close();
  });

  test.each([
    ['letters that no link has', () => `${link.slice(0, 60)}!!${link.slice(62)}`],
    ['cut off', () => link.slice(0, 80)],
    ['one letter changed', () => `${link.slice(0, 70)}${link[70] === 'A' ? 'B' : 'A'}${link.slice(71)}`],
  ])('a damaged link (%s) gets a sentence and loses nothing', async (_, damaged) => {
    const mine = await text();
    const opened = await open(damaged());
    await expect.poll(() => opened.getByRole('alert').innerText()).toMatch(/link is damaged[\s\S]*untouched/);
    await expect.poll(() => opened.evaluate(() => window.topple.text)).toBe(mine);
    await opened.close();
  });

  test('a damaged file gets a sentence and loses nothing', async () => {
    const mine = await text();
    const give = (name: string, words: string): Promise<void> =>
      page.getByLabel('Layout or recording file').setInputFiles({ name, mimeType: 'application/octet-stream', buffer: Buffer.from(words) });
    await give('bad.topple', 'TOPPLE01 and nothing more');
    await expect.poll(() => page.getByRole('alert').innerText()).toMatch(/cut off after 25 bytes/);
    expect(await text()).toBe(mine);
    await page.getByRole('button', { name: 'Close' }).click();
    await give('bad.toml', '[[row]]\ncount = many\n');
    await expect.poll(() => page.getByRole('alert').innerText()).toMatch(/^bad\.toml cannot be opened\.\nbad\.toml:2[\s\S]*untouched\.$/);
    expect(await text()).toBe(mine);
    await give('worse.toml', '[[row]]\ncount = -3\ngap_mm = 10\ncolour = "red"\n');
    await expect.poll(() => page.getByRole('alert').innerText()).toMatch(/worse\.toml:2:9: row\.0\.count: [\s\S]*worse\.toml:4:1: row\.0\.colour: /);
    await give('notes.pdf', 'not for us');
    await expect.poll(() => page.getByRole('alert').innerText()).toMatch(/notes\.pdf is neither a layout \(\.toml\) nor a recording \(\.topple\)/);
    expect(await text()).toBe(mine);
    await page.getByRole('button', { name: 'Close' }).click();
    await settled();
  });

  test('closes the tab in the middle of editing and finds all again', async () => {
    const mine = await text();
    await page.close();
    page = await open();
    expect(await text()).toBe(mine);
    await expect.poll(drawn).toBeGreaterThan(40);
  });

  test('nothing was reported as an error', () => expect(complaints).toEqual([]));
});

describe('the page', () => {
  test.each(golden)('%s by %s gives the golden hash in the browser', async (scene, model, hash) => {
    const layout = readFileSync(join(kRoot, 'scenes', scene), 'utf8');
    expect(await page.evaluate(([t, m]) => window.topple.runHash(t, [`model.name=${m}`]), [layout, model])).toBe(hash);
  });

  test('every scene of the gallery can be run: no warnings but the one that is meant to stop', async () => {
    for (const { name, text: scene } of kGallery) {
      await page.getByRole('button', { name: 'Scenes' }).click();
      await page.getByRole('dialog').getByRole('button', { name }).click();
      await page.waitForFunction((wanted) => window.topple.text === wanted && window.topple.settled, scene);
      const doubts = await page.evaluate(() => window.topple.doubts.join());
      if (name === 'Where it stops') expect(doubts).toMatch(/beyond reach/);
      else expect(doubts, name).toBe('');
      expect(await drawn(), name).toBeGreaterThan(20);
    }
  });

  test('by touch: a row is drawn with a finger and topples by a tap', async () => {
    const phone = await browser.newContext({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, reducedMotion: 'reduce' });
    const hand = listen(await phone.newPage());
    await hand.goto(`${site.url}?still=off`);
    await hand.waitForFunction(() => window.topple?.mode === 'draw');
    await hand.getByRole('button', { name: 'Row' }).tap();
    const client = await phone.newCDPSession(hand);
    const touch = (type: string, x: number): Promise<unknown> => client.send('Input.dispatchTouchEvent', { type: type as 'touchStart', touchPoints: type === 'touchEnd' ? [] : [{ x, y: 400 }] });
    const button = (await hand.getByRole('button', { name: 'Topple' }).boundingBox())!;
    await touch('touchStart', 60);
    for (let x = 90; x <= 330; x += 40) await touch('touchMove', x);
    await touch('touchEnd', 330);
    // At once, where the button was before: nothing else may have taken its place, and the engine need not have answered yet.
    await hand.touchscreen.tap(button.x + button.width / 2, button.y + button.height / 2);
    await toppled(hand);
    expect(await hand.evaluate(() => [window.topple.mode, window.topple.bricks > 5])).toEqual(['watch', true]);
    const after = (await hand.getByRole('button', { name: 'Draw', exact: true }).boundingBox())!;
    await hand.touchscreen.tap(after.x + after.width / 2, after.y + after.height / 2);
    await expect.poll(() => hand.getByRole('button', { name: 'Topple' }).boundingBox()).toEqual(button);
    expect(await axe(hand)).toEqual([]);
    await phone.close();
  });

  test.each([
    ['light', 1440, 900],
    ['dark', 1440, 900],
    ['light', 390, 844],
    ['dark', 390, 844],
  ] as const)('axe finds nothing serious, and nothing sticks out: %s, %i × %i', async (colorScheme, width, height) => {
    const other = await browser.newContext({ viewport: { width, height }, reducedMotion: 'reduce', colorScheme, hasTouch: width < 720 });
    const one = listen(await other.newPage());
    const look = async (what: string): Promise<void> => {
      await one.screenshot({ path: `${kOut}/studio-${what}-${width}-${colorScheme}.png` });
      expect(await axe(one), what).toEqual([]);
      expect(await one.evaluate(() => document.documentElement.scrollWidth <= innerWidth && document.body.scrollHeight <= innerHeight), what).toBe(true);
    };
    await one.goto(`${site.url}?still=off`);
    await one.waitForFunction(() => window.topple?.mode === 'draw');
    await look('empty');
    await one.goto(`${site.url}?still=off${link}`);
    await one.waitForFunction(() => window.topple?.drawn > 0 && window.topple.settled);
    await one.keyboard.press('n');
    await look('draw');
    await one.keyboard.press('Space');
    await toppled(one);
    await arrived(one);
    await pauseAt(one, 1);
    await look('watch');
    await one.keyboard.press('f');
    await one.locator('.legend').getByText('brick on brick').waitFor();
    await look('forces');
    await one.evaluate(() => window.topple.choose(9));
    await drawnIn(one);
    await look('forces of one');
    await one.keyboard.press('f');
    await one.getByRole('button', { name: 'Compare' }).click();
    await one.getByRole('article', { name: 'Rigid' }).getByText('Hash').waitFor();
    await look('compare');
    await one.keyboard.press('?');
    await look('keys');
    await other.close();
  });
  test('nothing was reported as an error in all this', () => expect(complaints).toEqual([]));
});

test.skipIf(!existsSync(kProgram))('topple studio --export writes the page; topple render makes a film without a window', async () => {
  const folder = await mkdtemp(join(tmpdir(), 'topple film '));
  execFileSync(kProgram, ['studio', '--export', join(folder, 'site')]);
  expect(existsSync(join(folder, 'site/index.html')) && existsSync(join(folder, 'site/engine.wasm'))).toBe(true);
  await writeFile(join(folder, 'site/recording.topple'), 'mine');
  execFileSync(kProgram, ['studio', '--export', join(folder, 'site')]);
  expect(readFileSync(join(folder, 'site/recording.topple'), 'utf8')).toBe('mine'); // what somebody put there stays
  await writeFile(join(folder, 'site/recording.topple'), '');
  const plain = await serveFolder(join(folder, 'site'));
  const visitor = await browser.newPage();
  const said: string[] = [];
  visitor.on('console', (message) => message.type() === 'error' && said.push(message.text()));
  await visitor.goto(plain.url, { waitUntil: 'networkidle' }); // all that is asked for has been answered
  await visitor.waitForFunction(() => window.topple?.mode === 'draw');
  expect(said).toEqual([]);
  await visitor.close();
  await plain.close();
  const film = join(folder, 'row.webm');
  execFileSync(kProgram, ['render', join(kRoot, 'studio/tests/page/row.toml'), '-o', film, '--size', '160x90', '--fps', '5', '--camera', 'front'], { stdio: 'pipe' });
  expect([...readFileSync(film).subarray(0, 4)]).toEqual([0x1a, 0x45, 0xdf, 0xa3]);
  await rm(folder, { recursive: true });
});

/** How many pixels of each of so many columns are colourful, as bricks are and the page is not. */
async function colorsIn(shown: Page, clip: { x: number; y: number; width: number; height: number }, columns: number): Promise<number[]> {
  const shot = (await shown.screenshot({ clip })).toString('base64');
  return shown.evaluate(async ([base64, n]) => {
    const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${base64}`)).blob());
    const pen = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d')!;
    pen.drawImage(bitmap, 0, 0);
    const { data, width } = pen.getImageData(0, 0, bitmap.width, bitmap.height);
    const found = new Array<number>(n as number).fill(0);
    for (let i = 0; i < data.length; i += 4) {
      const colors = data.slice(i, i + 3);
      if (Math.max(...colors) - Math.min(...colors) > 60) found[Math.min(found.length - 1, Math.floor((((i / 4) % width) * found.length) / width))]++;
    }
    return found;
  }, [shot, columns] as const);
}
