/** The engine alone in a worker of a browser, for measure_ratio.ts: runs a layout, then says its hash. */

import { Engine } from '../../src/engine/engine.ts';

const engine = fetch('engine.wasm').then(async (answer) => Engine.load(await answer.arrayBuffer()));

self.onmessage = async ({ data }: MessageEvent<{ text: string; name: string; overrides: string[] } | 'hash'>) => {
  const c = await engine;
  if (data === 'hash') {
    c.collect(true);
    self.postMessage(c.hash);
    return;
  }
  c.start(data.text, data.name, data.overrides);
  while (c.advance(4096));
  self.postMessage('');
};
