/** What a part of a layout file is on the table, and how it is moved, turned and mirrored. Plane geometry of the file's own numbers: mm and degrees. */

import type { Block, TomlFile, TomlValue } from './toml.ts';

export interface Point {
  x: number;
  y: number;
}

/** Lists of the layout file whose entries make bricks. */
export const kPartNames = ['row', 'curve', 'brick', 'field', 'wall', 'tower', 'pyramid', 'ball'] as const;

/** The entries that make bricks, in the order of the file, which is that of the bricks. */
export function partsOf(file: TomlFile): Block[] {
  return file.blocks.filter((block) => block.isList && (kPartNames as readonly string[]).includes(block.name));
}

/** What messages and the engine call it: "row 2". */
export function nameOf(file: TomlFile, part: Block): string {
  return `${part.name} ${file.list(part.name).indexOf(part) + 1}`;
}

const pointFrom = (value: TomlValue | undefined): Point =>
  Array.isArray(value) && typeof value[0] === 'number' && typeof value[1] === 'number' ? { x: value[0], y: value[1] } : { x: 0, y: 0 };

/** The points that say where a part is: those of a curve, else its one place. */
export function pointsOf(part: Block): Point[] {
  const points = part.get('points_mm');
  if (Array.isArray(points)) return points.map(pointFrom);
  return [pointFrom(part.get(placeKey(part)))];
}

function placeKey(part: Block): string {
  return part.name === 'row' || part.name === 'field' ? 'from_mm' : 'at_mm';
}

export function setPoints(part: Block, points: readonly Point[]): void {
  if (part.name === 'curve') return part.set('points_mm', points.map((p) => [p.x, p.y]));
  const key = placeKey(part);
  const old = part.get(key);
  const height = Array.isArray(old) ? old.slice(2) : [];
  part.set(key, [points[0].x, points[0].y, ...height]);
}

export function headingOf(part: Block): number {
  return part.number('heading_deg', 0);
}

const kRadians = Math.PI / 180;

/** Turned counter-clockwise about a place [mm, deg]. */
export function turned(p: Point, about: Point, degrees: number): Point {
  const [c, s] = [Math.cos(degrees * kRadians), Math.sin(degrees * kRadians)];
  const [x, y] = [p.x - about.x, p.y - about.y];
  return { x: about.x + c * x - s * y, y: about.y + s * x + c * y };
}

export function movePart(part: Block, dx: number, dy: number): void {
  setPoints(part, pointsOf(part).map((p) => ({ x: p.x + dx, y: p.y + dy })));
}

export function turnPart(part: Block, about: Point, degrees: number): void {
  setPoints(part, pointsOf(part).map((p) => turned(p, about, degrees)));
  if (part.name !== 'curve') setHeading(part, headingOf(part) + degrees);
}

/** Left and right exchanged, about the line x = `x`. */
export function mirrorPart(part: Block, x: number): void {
  setPoints(part, pointsOf(part).map((p) => ({ x: 2 * x - p.x, y: p.y })));
  if (part.name !== 'curve') setHeading(part, 180 - headingOf(part));
}

export function setHeading(part: Block, degrees: number): void {
  const whole = degrees - 360 * Math.floor((degrees + 180) / 360);
  part.set('heading_deg', whole);
}

/** Of a kind by its name, or of the first one where there is none of that name [mm]. */
export function sizeOf(file: TomlFile, kind: string): { height: number; width: number; thickness: number } {
  const kinds = file.list('kind');
  const found = kinds.find((one) => one.string('name') === kind) ?? kinds[0];
  return { height: found?.number('height_mm', 48) ?? 48, width: found?.number('width_mm', 24) ?? 24, thickness: found?.number('thickness_mm', 7.5) ?? 7.5 };
}

/** Bricks of a part in colours of their own: [first, last, colour], counted within the part. */
export type PaintStroke = [number, number, string];

export function paintOf(part: Block): PaintStroke[] {
  const value = part.get('paint');
  return Array.isArray(value) ? value.filter((one): one is PaintStroke => Array.isArray(one) && one.length === 3) : [];
}

/** Gives one brick of a part a colour; strokes next to each other in one colour become one. */
export function paintBrick(part: Block, brick: number, color: string): void {
  const colors = new Map<number, string>();
  for (const [first, last, stroke] of paintOf(part)) for (let i = first; i <= last; i++) colors.set(i, stroke);
  colors.set(brick, color);
  const strokes: PaintStroke[] = [];
  for (const i of [...colors.keys()].sort((a, b) => a - b)) {
    const before = strokes.at(-1);
    const own = colors.get(i) as string;
    if (before && before[1] === i - 1 && before[2] === own) before[1] = i;
    else strokes.push([i, i, own]);
  }
  part.set('paint', strokes);
}

/** Size along the fall of a standing brick of the part's kind [mm]. */
export function thicknessOf(file: TomlFile, part: Block): number {
  const kinds = file.list('kind');
  const kind = kinds.find((one) => one.string('name') === part.string('kind')) ?? kinds[0];
  const side = part.string('pose') === 'flat' ? 'height_mm' : 'thickness_mm';
  return kind?.number(side, side === 'height_mm' ? 48 : 7.5) ?? (side === 'height_mm' ? 48 : 7.5);
}

/** Face to face [mm]. */
export function gapOf(file: TomlFile, part: Block): number {
  const gap = part.get('gap_mm');
  return typeof gap === 'number' ? gap : part.number('pitch_mm', 24) - thicknessOf(file, part);
}

export function setGap(part: Block, gap: number): void {
  part.remove('pitch_mm');
  part.set('gap_mm', gap);
}

/** Keys of other parts that a part of a name does not know. */
const kUnknown: Record<string, readonly string[]> = { brick: ['color_to'], ball: ['color_to', 'kind'] };

export function knows(part: Block, key: string): boolean {
  if (key.startsWith('color') && part.has('picture') && part.string('starter') !== 'line') return false; // no brick would show it
  return !kUnknown[part.name]?.includes(key);
}
