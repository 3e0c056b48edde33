/** Every key of the player, and what it does. */

import type { Player } from './player.svelte.ts';
import type { Stage } from './stage.svelte.ts';

export const kKeyList: { title: string; keys: { keys: string[]; does: string }[] }[] = [
  {
    title: 'Playing',
    keys: [
      { keys: ['Space'], does: 'Play or pause' },
      { keys: ['←', '→'], does: 'One frame back or on: 1/60 s of watching; with Shift ten' },
      { keys: ['↑', '↓'], does: 'Event before or after, of the chosen brick or of the run' },
      { keys: ['Home', 'End'], does: 'To the start or the end' },
      { keys: ['[', ']'], does: 'Slower or faster' },
      { keys: ['\\'], does: 'True speed, 1×' },
      { keys: ['S'], does: 'Slow motion around the cursor, over and over; again: on as before' },
      { keys: ['L'], does: 'Loop; drag over the time axis for a part of the run' },
    ],
  },
  {
    title: 'Looking',
    keys: [
      { keys: ['1'], does: 'Orbit: drag turns, right drag or two fingers move, wheel zooms' },
      { keys: ['2'], does: 'Follow the front' },
      { keys: ['3'], does: 'Brick’s eye' },
      { keys: ['4'], does: 'From the top' },
      { keys: ['0'], does: 'Frame all' },
      { keys: ['G'], does: 'Ghost: the bricks as they were put down' },
      { keys: ['F'], does: 'Forces: what presses on what now, as arrows' },
      { keys: ['M'], does: 'Measure: click two places on the table' },
      { keys: ['H'], does: 'Heat: colour the bricks by when they were struck' },
    ],
  },
  {
    title: 'Bricks',
    keys: [
      { keys: ['N'], does: 'Next brick; with Shift the one before' },
      { keys: ['Esc'], does: 'Stop measuring, choose none' },
      { keys: ['Click'], does: 'Choose a brick' },
    ],
  },
  {
    title: 'Page',
    keys: [
      { keys: ['?'], does: 'These keys' },
      { keys: ['Alt'], does: 'While dragging on the timeline: do not catch on events' },
    ],
  },
];

/** What the page itself does, beside the player and the stage. */
export interface PageActions {
  showKeys: () => void;
  toggleHeat: () => void;
  toggleGhost: () => void;
  toggleForces: () => void;
  toggleMeasure: () => void;
  /** Leaves what is under way: measuring, else the choice of a brick. */
  leave: () => void;
}

/** @returns Whether the key was one of ours. */
export function pressKey(event: KeyboardEvent, player: Player, stage: Stage, page: PageActions): boolean {
  if (event.ctrlKey || event.metaKey || event.altKey) return false;
  const action = actionFor(event.key, event.shiftKey, player, stage, page);
  if (!action) return false;
  action();
  return true;
}

function actionFor(key: string, shift: boolean, player: Player, stage: Stage, page: PageActions): (() => void) | undefined {
  const frames = shift ? 10 : 1;
  const actions: Record<string, () => void> = {
    ' ': () => player.toggle(),
    ArrowLeft: () => player.step(-frames),
    ArrowRight: () => player.step(frames),
    ArrowUp: () => player.seekEvent(-1),
    ArrowDown: () => player.seekEvent(1),
    Home: () => player.seek(0),
    End: () => player.seek(player.duration),
    '[': () => player.changeSpeed(-1),
    ']': () => player.changeSpeed(1),
    '\\': () => (player.speed = 1),
    s: () => player.toggleSlow(),
    l: () => (player.looping = !player.looping),
    '1': () => stage.setWay('orbit'),
    '2': () => stage.setWay('front'),
    '3': () => stage.setWay('eye'),
    '4': () => stage.setWay('top'),
    '0': () => stage.frameAll(),
    n: () => player.chooseNext(shift ? -1 : 1),
    g: () => page.toggleGhost(),
    f: () => page.toggleForces(),
    m: () => page.toggleMeasure(),
    h: () => page.toggleHeat(),
    '?': () => page.showKeys(),
    Escape: () => page.leave(),
  };
  return actions[key.length === 1 ? key.toLowerCase() : key];
}
