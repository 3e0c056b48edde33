/** Forces at contacts as arrows in a picture: where their lines, heads and points lie, as paths of SVG and of a canvas alike. */

import { Vector3 } from 'three';
import type { Recording } from '../recording/types.ts';
import { kFloor, type ContactForce } from './contact_steps.ts';

/** Of the tallest kind: how long an arrow is for the weight of such a brick, and at most. */
const kPerWeight = 0.5;
const kLongest = 2;
/** The largest are drawn where there are more. */
const kMost = 800;

export interface Arrows {
  lines: string;
  heads: string;
  points: string;
}
/** In this order they are drawn: the second over the first. */
export interface ArrowPaths {
  floor: Arrows;
  brick: Arrows;
}

/** A place [m, in the layout's axes] in pixels of the picture; null behind the camera. */
export type Project = (place: Vector3) => { x: number; y: number } | null | undefined;

export const forceOf = (one: ContactForce): number => Math.hypot(...one.force);

/** The tallest kind, by which arrows are measured: its height [m] and weight [N]. */
export function usualBrick(recording: Recording | null): { height: number; weight: number } {
  const kind = [...(recording?.kinds ?? [])].sort((a, b) => b.height - a.height)[0];
  return { height: kind?.height ?? 0.048, weight: (kind?.mass ?? 0.009) * (recording?.gravity ?? 9.81) };
}

/**
 * @param chosen Only what presses on this brick, or what it presses on; -1: all.
 * @param scale Of the heads: 1 for a page.
 */
export function arrowPaths(recording: Recording, contacts: ContactForce[], chosen: number, project: Project, scale = 1): ArrowPaths {
  const none = (): Arrows => ({ lines: '', heads: '', points: '' });
  const paths = { floor: none(), brick: none() };
  const usual = usualBrick(recording);
  const { count } = recording.bricks;
  let shown = contacts.filter((one) => one.brick < count && (chosen < 0 || one.brick === chosen || one.by === chosen));
  if (shown.length > kMost) shown = shown.sort((a, b) => forceOf(b) - forceOf(a)).slice(0, kMost);
  for (const one of shown) {
    const [at, end] = endsOf(recording, one, usual);
    const [from, to] = [project(at), project(end)];
    if (from && to) add(from, to, scale, one.by === kFloor ? paths.floor : paths.brick);
  }
  return paths;
}

/** One arrow a point: what the floor presses goes up, what bricks press goes the way of the wave; the other brick feels the opposite. */
function endsOf(recording: Recording, one: ContactForce, usual: { height: number; weight: number }): [Vector3, Vector3] {
  const { foot, heading } = recording.bricks;
  const at = new Vector3(...[0, 1, 2].map((axis) => foot[3 * one.brick + axis] + one.point[axis]) as [number, number, number]);
  const along = one.force[0] * Math.cos(heading[one.brick]) + one.force[1] * Math.sin(heading[one.brick]);
  const side = one.by === kFloor || along >= 0 ? 1 : -1;
  const length = Math.min(kLongest, (kPerWeight * forceOf(one)) / usual.weight) * usual.height;
  return [at, at.clone().addScaledVector(new Vector3(...one.force).normalize(), side * length)];
}

function add(from: { x: number; y: number }, to: { x: number; y: number }, scale: number, out: Arrows): void {
  const p = (x: number, y: number): string => `${x.toFixed(1)} ${y.toFixed(1)}`;
  out.points += `M${p(from.x, from.y)}h0`;
  const long = Math.hypot(to.x - from.x, to.y - from.y);
  if (long < 2 * scale) return;
  const [ux, uy] = [(to.x - from.x) / long, (to.y - from.y) / long];
  const head = Math.min(8 * scale, 0.6 * long);
  const [bx, by] = [to.x - head * ux, to.y - head * uy];
  out.lines += `M${p(from.x, from.y)}L${p(bx, by)}`;
  out.heads += `M${p(to.x, to.y)}L${p(bx - 0.5 * head * uy, by + 0.5 * head * ux)}L${p(bx + 0.5 * head * uy, by - 0.5 * head * ux)}Z`;
}
