/** A browser, a small static server for the built page, and recordings to play: what every page test stands on. */

import { execFile } from 'node:child_process';
import { existsSync } from 'node:fs';
import { mkdir, mkdtemp, readFile, rm } from 'node:fs/promises';
import { createServer, type Server } from 'node:http';
import { tmpdir } from 'node:os';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { chromium, type Browser, type BrowserContext, type Page } from 'playwright-core';
import { makeRecording } from '../make_recording.ts';
import { kPatience } from '../patience.ts';

const kHere = fileURLToPath(new URL('.', import.meta.url));
const kDist = join(kHere, '../../dist');
export const kOut = join(kHere, '../out');
export const kRoot = join(kHere, '../../..');
/** The program of this tree, or another. It may not be there. */
export const kProgram = process.env.TOPPLE_PROGRAM ?? join(kRoot, 'build/release/topple');

/** TOPPLE_SLOWER=6 makes the page's own thread so much slower: what a test then finds too early, it finds too early on a slower machine. */
const kSlower = Number(process.env.TOPPLE_SLOWER ?? 1);

const kTypes: Record<string, string> = {
  '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml', '.json': 'application/json',
};

export interface Site {
  url: string;
  close(): Promise<void>;
}

/** Serves dist at / and `recording` at /recording.topple, on loopback; null: there is no recording. */
export async function serve(recording: Uint8Array | null, summary: object | null = null): Promise<Site> {
  const server: Server = createServer((request, response) => {
    const path = normalize(new URL(request.url ?? '/', 'http://localhost').pathname);
    if (path === '/recording.topple' && recording) return response.writeHead(200, { 'content-length': recording.length }).end(recording);
    if (path === '/summary.json' && summary) return response.writeHead(200).end(JSON.stringify(summary));
    const file = join(kDist, path === '/' ? 'index.html' : path);
    readFile(file).then(
      (bytes) => response.writeHead(200, { 'content-type': kTypes[extname(file)] ?? 'application/octet-stream' }).end(bytes),
      () => response.writeHead(path === '/summary.json' || path === '/recording.topple' ? 204 : 404).end(),
    );
  });
  return listening(server);
}

/** Serves a folder as any server of plain files does: what is not there is 404. */
export async function serveFolder(folder: string): Promise<Site> {
  const server = createServer((request, response) => {
    const path = normalize(new URL(request.url ?? '/', 'http://localhost').pathname);
    const file = join(folder, path === '/' ? 'index.html' : path);
    readFile(file).then(
      (bytes) => response.writeHead(200, { 'content-type': kTypes[extname(file)] ?? 'application/octet-stream' }).end(bytes),
      () => response.writeHead(404).end(),
    );
  });
  return listening(server);
}

async function listening(server: Server): Promise<Site> {
  await new Promise<void>((ready) => server.listen(0, '127.0.0.1', ready));
  const address = server.address();
  const port = typeof address === 'object' && address ? address.port : 0;
  return {
    url: `http://127.0.0.1:${port}/`,
    close: () => new Promise((done) => { server.closeAllConnections?.(); server.close(() => done()); }),
  };
}

/** Debian's Chromium (or TOPPLE_CHROMIUM), drawing in software. @param more Its flags. */
export async function launch(webGl = true, more: string[] = []): Promise<Browser> {
  const flags = ['--no-sandbox', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run', '--mute-audio'];
  const drawing = webGl ? ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'] : ['--disable-gpu', '--disable-3d-apis', '--disable-webgl', '--disable-webgl2'];
  const browser = await chromium.launch({ executablePath: process.env.TOPPLE_CHROMIUM ?? '/usr/bin/chromium', args: [...flags, ...drawing, ...more], timeout: kPatience });
  const newContext = browser.newContext.bind(browser);
  browser.newContext = async (options) => patient(await newContext(options));
  browser.newPage = async (options) => (await browser.newContext(options)).newPage();
  return browser;
}

/** Its pages are waited for as long as a slow machine needs. */
function patient(context: BrowserContext): BrowserContext {
  context.setDefaultTimeout(kPatience);
  if (kSlower > 1) context.on('page', (page) => void context.newCDPSession(page).then((session) => session.send('Emulation.setCPUThrottlingRate', { rate: kSlower })));
  return context;
}

/** Until the run of the drawn layout is over. */
export async function toppled(page: Page): Promise<void> {
  await page.waitForFunction(() => window.topple.hash !== '');
}

/** Until the camera stands where it is meant to: it comes nearer only once the view has the size in which a run is watched. */
export async function arrived(page: Page): Promise<void> {
  await page.waitForFunction(() => window.topple.arrived);
}

/** Stops playing and puts the bricks where they are at a time [s]; the space bar would play again where the end has come by itself. */
export async function pauseAt(page: Page, time: number): Promise<void> {
  await page.evaluate((at) => {
    window.topple.pause();
    window.topple.seek(at);
  }, time);
  await drawn(page);
}

/** Two frames: what was asked for has been drawn. */
export async function drawn(page: Page): Promise<void> {
  await page.evaluate(() => new Promise<void>((done) => requestAnimationFrame(() => requestAnimationFrame(() => done()))));
}

/**
 * A recording to test with: made by the program of this tree (or TOPPLE_PROGRAM) from a layout, or made up where there is no program.
 * @param layout TOML, or the path of a scene from the repository's root.
 */
export async function recordingOf(layout: string, instead: () => Uint8Array): Promise<{ bytes: Uint8Array; real: boolean }> {
  if (!existsSync(kProgram) || !existsSync(join(kRoot, layout))) return { bytes: instead(), real: false };
  const folder = await mkdtemp(join(tmpdir(), 'topple-page-'));
  try {
    const file = join(folder, 'run.topple');
    await promisify(execFile)(kProgram, ['run', join(kRoot, layout), '--out', file]);
    return { bytes: new Uint8Array(await readFile(file)), real: true };
  } finally {
    await rm(folder, { recursive: true, force: true });
  }
}

export { makeRecording, mkdir };
