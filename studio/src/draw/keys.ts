/** Keys while one draws. */

import type { Stage } from '../player/stage.svelte.ts';
import type { Hand } from './hand.svelte.ts';
import { partsOf } from './parts.ts';
import type { Studio, Tool } from './studio.svelte.ts';
import { kTools } from './tool_rail.svelte';

export interface DrawActions {
  topple: () => void;
  chooseTool: (tool: Tool) => void;
  showKeys: () => void;
}

export const kDrawKeys: { title: string; keys: { keys: string[]; does: string }[] }[] = [
  { title: 'Tools', keys: kTools.map(({ key, name }) => ({ keys: [key], does: name })) },
  {
    title: 'Drawing',
    keys: [
      { keys: ['Enter'], does: 'Put down what the tool draws, on from the last part' },
      { keys: ['Shift'], does: 'While dragging: steps of 15°' },
      { keys: ['Alt'], does: 'While dragging: do not catch on the end of a part' },
      { keys: ['Esc'], does: 'Leave the tool, choose none' },
    ],
  },
  {
    title: 'Parts',
    keys: [
      { keys: ['N'], does: 'Next part; with Shift the one before' },
      { keys: ['Ctrl', 'A'], does: 'Choose all' },
      { keys: ['←', '→', '↑', '↓'], does: 'Move by 1 mm; with Shift by 10 mm' },
      { keys: ['Q', 'E'], does: 'Turn by 1°; with Shift by 15°' },
      { keys: ['X'], does: 'Mirror' },
      { keys: ['Ctrl', 'D'], does: 'Duplicate' },
      { keys: ['Del'], does: 'Delete' },
      { keys: ['Ctrl', 'Z'], does: 'Undo; with Shift redo' },
    ],
  },
  {
    title: 'Page',
    keys: [
      { keys: ['Space'], does: 'Topple' },
      { keys: ['1'], does: 'Over the table: right drag turns, two fingers or the middle button move, wheel zooms' },
      { keys: ['4'], does: 'From the top' },
      { keys: ['0'], does: 'Frame all' },
      { keys: ['?'], does: 'These keys' },
    ],
  },
];

/** @returns Whether the key was one of ours. */
export function pressDrawKey(event: KeyboardEvent, studio: Studio, stage: Stage, hand: Hand, page: DrawActions): boolean {
  const action = event.ctrlKey || event.metaKey ? withControl(event, studio) : event.altKey ? undefined : plain(event, studio, stage, hand, page);
  action?.();
  return action !== undefined;
}

function withControl(event: KeyboardEvent, studio: Studio): (() => void) | undefined {
  const actions: Record<string, () => void> = {
    z: () => (event.shiftKey ? studio.redo() : studio.undo()),
    y: () => studio.redo(),
    d: () => studio.duplicate(),
    a: () => (studio.chosen = partsOf(studio.file).map((_, i) => i)),
  };
  return actions[event.key.toLowerCase()];
}

function plain(event: KeyboardEvent, studio: Studio, stage: Stage, hand: Hand, page: DrawActions): (() => void) | undefined {
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  const tool = kTools.find((one) => one.key.toLowerCase() === key);
  if (tool) return () => page.chooseTool(tool.tool);
  const far = event.shiftKey ? 10 : 1;
  const turn = event.shiftKey ? 15 : 1;
  const any = studio.chosen.length > 0;
  const whenChosen = (act: () => void): (() => void) | undefined => (any ? act : undefined);
  const next = (): void => {
    const count = partsOf(studio.file).length;
    if (count) studio.chosen = [((studio.chosen.at(-1) ?? -1) + (event.shiftKey ? count - 1 : 1) + count) % count];
  };
  const actions: Record<string, (() => void) | undefined> = {
    ' ': () => page.topple(),
    Enter: () => hand.putDown(),
    Delete: whenChosen(() => studio.remove()),
    Backspace: whenChosen(() => studio.remove()),
    x: whenChosen(() => studio.mirror()),
    q: whenChosen(() => studio.turn(turn)),
    e: whenChosen(() => studio.turn(-turn)),
    ArrowLeft: whenChosen(() => studio.move(-far, 0)),
    ArrowRight: whenChosen(() => studio.move(far, 0)),
    ArrowUp: whenChosen(() => studio.move(0, far)),
    ArrowDown: whenChosen(() => studio.move(0, -far)),
    n: next,
    '1': () => stage.setWay('orbit'),
    '4': () => stage.setWay('top'),
    '0': () => stage.frameAll(),
    '?': () => page.showKeys(),
    Escape: () => {
      hand.cancel();
      if (studio.tool === 'select') studio.chosen = [];
      page.chooseTool('select');
    },
  };
  return actions[key];
}
