/** Files that come from the disk: recordings go to the player, layouts to the drawing table. */

import { load, type LoadProgress } from '../recording/load.ts';
import type { Order } from '../recording/worker.ts';
import type { Player } from './player.svelte.ts';

export interface Opening {
  /** Tells after 0.4 s that it is slow: what is quick needs no bar. */
  slow: (slow: boolean) => void;
  opened: () => void;
  /** Nothing is at the address. */
  absent: () => void;
}

/** Opens a recording. @returns How to cancel it. */
export function openRecording(order: Order, player: Player, on: Opening): () => void {
  player.progress = { words: '', part: NaN };
  on.slow(false);
  const timer = setTimeout(() => on.slow(true), 400);
  const ended = (): void => {
    clearTimeout(timer);
    on.slow(false);
    player.progress = null;
  };
  const stop = load(order, {
    progress: (p: LoadProgress) => (player.progress = p),
    failed: (message) => {
      ended();
      if (message === 'There is no recording here.') on.absent();
      else player.failure = message;
    },
    done: (loaded) => {
      ended();
      player.open(loaded);
      on.opened();
    },
  });
  return () => {
    stop();
    ended();
  };
}

export function download(bytes: BlobPart, name: string, type: string): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([bytes], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** A title as a file's name, without an ending. */
export function fileName(title: string): string {
  return (title || 'topple').toLowerCase().replace(/[^a-z0-9]+/g, '-').replace(/^-|-$/g, '') || 'topple';
}
