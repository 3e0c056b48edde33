/** Decodes off the page's thread. Takes an address or bytes, tells how far it is, hands the arrays over without copying. */

import { buffersOf } from './buffers.ts';
import { decodeRecording, FormatError } from './decode.ts';
import { FetchError, fetchBytes } from './fetch_bytes.ts';
import { findFalls, findFront, type Front } from './wave.ts';
import type { Recording } from './types.ts';

export type Order = { url: string } | { bytes: ArrayBuffer };

export type Report =
  | { kind: 'loading'; bytes: number; of: number }
  | { kind: 'decoding'; bricks: number; done: number }
  | { kind: 'done'; recording: Recording; front: Front; falls: Float64Array }
  | { kind: 'failed'; message: string };

const tell = (report: Report, transfer: Transferable[] = []): void => self.postMessage(report, { transfer });

self.onmessage = async (message: MessageEvent<Order>) => {
  try {
    const order = message.data;
    const bytes =
      'bytes' in order
        ? new Uint8Array(order.bytes)
        : await fetchBytes(order.url, (done, of) => tell({ kind: 'loading', bytes: done, of }));
    const recording = decodeRecording(bytes, ({ bricks, done }) => tell({ kind: 'decoding', bricks, done }));
    const front = findFront(recording);
    const falls = findFalls(recording);
    tell({ kind: 'done', recording, front, falls }, buffersOf(recording));
  } catch (error) {
    const known = error instanceof FormatError || error instanceof FetchError;
    tell({ kind: 'failed', message: known ? error.message : `The recording cannot be read: ${String(error)}` });
  }
};
