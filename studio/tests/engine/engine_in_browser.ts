/** The page's engine in a worker of Chromium, and the processor time of the process that it runs in. */

import { copyFileSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { build } from 'vite';
import { launch, serveFolder } from '../page/browser.ts';

export interface Turn {
  /** Of all threads of the page's process [s]. */
  cpu: number;
  hash: string;
}

export interface EngineInBrowser {
  run(text: string, name: string, overrides: string[]): Promise<Turn>;
  close(): Promise<void>;
}

/** What all threads of a process have had of a processor [s], to the microsecond. */
function cpuOf(process: number): number {
  const threads = readdirSync(`/proc/${process}/task`);
  return threads.reduce((sum, thread) => sum + Number(readFileSync(`/proc/${process}/task/${thread}/schedstat`, 'utf8').split(' ')[0]) / 1e9, 0);
}

/** @param module Path of engine.wasm. */
export async function openEngineInBrowser(module: string): Promise<EngineInBrowser> {
  const folder = await mkdtemp(join(tmpdir(), 'topple-ratio-'));
  const entry = new URL('./ratio_worker.ts', import.meta.url).pathname;
  await build({ configFile: false, logLevel: 'silent', build: { outDir: folder, target: 'es2022', lib: { entry, formats: ['es'], fileName: () => 'worker.js' } } });
  copyFileSync(module, join(folder, 'engine.wasm'));
  writeFileSync(join(folder, 'index.html'), '<!doctype html><title>engine</title>');
  const site = await serveFolder(folder);
  const browser = await launch();
  const page = await browser.newPage();
  await page.goto(site.url);
  await page.evaluate(() => {
    const worker = new Worker('worker.js', { type: 'module' });
    const ask = (order: unknown): Promise<string> =>
      new Promise((resolve, reject) => {
        worker.onmessage = ({ data }: MessageEvent<string>) => resolve(data);
        worker.onerror = (event) => reject(new Error(event.message));
        worker.postMessage(order);
      });
    Object.assign(window, { ask });
  });
  const ask = (order: unknown): Promise<string> => page.evaluate((one) => (window as never as { ask: (order: unknown) => Promise<string> }).ask(one), order);
  const session = await browser.newBrowserCDPSession();
  const { processInfo } = await session.send('SystemInfo.getProcessInfo');
  // More than one may be there, for a page to come; they do nothing.
  const renderers = processInfo.filter(({ type }) => type === 'renderer').map(({ id }) => id);
  const cpu = (): number => renderers.reduce((sum, process) => sum + cpuOf(process), 0);
  return {
    run: async (text, name, overrides) => {
      const before = cpu();
      await ask({ text, name, overrides });
      const taken = cpu() - before;
      return { cpu: taken, hash: await ask('hash') };
    },
    close: async () => {
      await browser.close();
      await site.close();
      await rm(folder, { recursive: true });
    },
  };
}
