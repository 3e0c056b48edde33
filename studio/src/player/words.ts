/** Numbers and events as people read them: no more digits than are true, a real minus, an en dash for what is not there. */

import { EventKind, kNoBrick, PushWay, type Kind, type Push, type Recording } from '../recording/types.ts';

export function fixed(value: number, digits: number): string {
  if (!Number.isFinite(value)) return '–';
  const text = value.toFixed(digits);
  return text.startsWith('-') ? (Number(text) === 0 ? text.slice(1) : `−${text.slice(1)}`) : text;
}

/** Three significant digits where that needs a point, else whole. */
export function short(value: number): string {
  if (!Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  return fixed(value, size >= 100 ? 0 : size >= 10 ? 1 : size >= 0.1 || size === 0 ? 2 : 4);
}

export function count(value: number): string {
  return value.toLocaleString('en-GB');
}

const millimetres = (metres: number): string => String(Number((metres * 1000).toPrecision(4)));

export function kindWords(kind: Kind): string {
  const name = kind.name.charAt(0).toUpperCase() + kind.name.slice(1);
  const size = [kind.height, kind.width, kind.thickness].map(millimetres).join(' × ');
  return `${name} ${size} mm, ${Number((kind.mass * 1000).toPrecision(3))} g`;
}

export function pushWords(push: Push): string {
  const height = `${millimetres(push.height)} mm up`;
  if (push.way === PushWay.angularSpeed) return `${short(push.value)} rad/s about its toe`;
  if (push.way === PushWay.force) return `${short(push.value)} N, ${height}, for ${millimetres(push.duration)} ms`;
  return `${short(push.value * 1000)} mN s, ${height}`;
}

/** One event as the brick at its side would tell it. */
export function eventWords(recording: Recording, event: number, brick: number): string {
  const { events } = recording;
  const other = events.brick[event] === brick ? events.by[event] : events.brick[event];
  const mine = events.brick[event] === brick;
  const height = events.where[3 * event + 2];
  const where = Number.isFinite(height) ? `, ${fixed(height * 1000, 1)} mm up` : '';
  const force = Number.isFinite(events.force[event]) ? `, ${fixed(events.force[event], 4)} N` : '';
  switch (events.kind[event] as EventKind) {
    case EventKind.pushed:
      return `pushed${force}`;
    case EventKind.struck:
      return (mine ? `struck by ${other}` : `strikes ${other}`) + where + force;
    case EventKind.arrived:
      return mine ? 'tilt passes 10°' : `${other} passes 10°`;
    case EventKind.landed:
      if (other === kNoBrick) return 'lands on the table';
      return mine ? `lands on ${other}, leans from now on` : `${other} lands on it`;
    case EventKind.missed:
      return mine ? 'falls flat without reaching the next' : `${other} misses it`;
    default:
      return mine ? 'comes to rest' : `${other} comes to rest`;
  }
}

/** For the middle of a sentence. */
export const lowered = (words: string): string => words.charAt(0).toLowerCase() + words.slice(1);

/** With a capital and a full stop. */
export function sentence(words: string): string {
  const trimmed = words.trim();
  return trimmed.charAt(0).toUpperCase() + trimmed.slice(1) + (/[.!?]$/.test(trimmed) ? '' : '.');
}
