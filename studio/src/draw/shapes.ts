/** What the drawing tools put into the file: a few numbers for each stroke of the hand. mm and degrees; where the bricks then stand is the engine's work. */

import type { Point } from './parts.ts';
import { writeValue } from './toml.ts';

/** What every new part is given. */
export interface Style {
  gap: number;
  color: string;
  /** Of the last brick; empty: as `color`. */
  colorTo: string;
  /** Empty: the first kind. */
  kind: string;
}

function styleLines(style: Style): string {
  let lines = `gap_mm = ${writeValue(style.gap)}\n`;
  if (style.kind) lines += `kind = ${writeValue(style.kind)}\n`;
  lines += `color = ${writeValue(style.color)}\n`;
  if (style.colorTo) lines += `color_to = ${writeValue(style.colorTo)}\n`;
  return lines;
}

const degrees = (radians: number): number => (radians * 180) / Math.PI;
const pointText = (p: Point): string => writeValue([Math.round(p.x * 10) / 10, Math.round(p.y * 10) / 10]);
const distance = (a: Point, b: Point): number => Math.hypot(b.x - a.x, b.y - a.y);

export function rowText(from: Point, to: Point, style: Style, pitch: number): string {
  const count = Math.max(1, Math.floor(distance(from, to) / pitch + 1e-6) + 1);
  const heading = degrees(Math.atan2(to.y - from.y, to.x - from.x));
  return `[[row]]\nfrom_mm = ${pointText(from)}\nheading_deg = ${writeValue(heading)}\ncount = ${count}\n${styleLines(style)}`;
}

export function curveText(points: readonly Point[], style: Style): string {
  return `[[curve]]\npoints_mm = [${points.map(pointText).join(', ')}]\n${styleLines(style)}`;
}

export function brickText(at: Point, heading: number, style: Style): string {
  const { color, kind } = style;
  return `[[brick]]\nat_mm = ${pointText(at)}\nheading_deg = ${writeValue(heading)}\n${kind ? `kind = ${writeValue(kind)}\n` : ''}color = ${writeValue(color)}\n`;
}

/** Rows side by side over the rectangle between two corners, started by a line along their heads. */
export function fieldText(a: Point, b: Point, style: Style, pitch: number, width: number): string {
  const rowPitch = Math.max(3 * width + 4, 2.5 * pitch + 4, 76);
  const rows = Math.max(1, Math.floor(Math.abs(b.y - a.y) / rowPitch) + 1);
  const count = Math.max(2, Math.floor(Math.abs(b.x - a.x) / pitch) + 1);
  const from = { x: Math.min(a.x, b.x), y: Math.min(a.y, b.y) };
  const starter = rows > 1 ? 'line' : 'none';
  return `[[field]]\nfrom_mm = ${pointText(from)}\nrows = ${rows}\nrow_pitch_mm = ${writeValue(rowPitch)}\ncount = ${count}\nstarter = "${starter}"\n${styleLines(style)}`;
}

/** What its colours and kind say, without a gap. */
function plainStyle(style: Style): string {
  return styleLines(style).replace(/^gap_mm.*\n/, '');
}

const heightOf = (size: { height: number }): number => size.height;
const middle = (a: Point, b: Point): Point => ({ x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 });

/** Bricks of a wall's lowest course between two places: they lie on their long narrow side. */
export function wallCount(from: Point, to: Point, size: { height: number }): number {
  return Math.max(1, Math.round(distance(from, to) / heightOf(size)));
}
export function wallText(from: Point, to: Point, style: Style, size: { height: number }): string {
  const heading = degrees(Math.atan2(to.y - from.y, to.x - from.x)) - 90;
  return `[[wall]]\nat_mm = ${pointText(middle(from, to))}\nheading_deg = ${writeValue(heading)}\ncount = ${wallCount(from, to, size)}\ncourses = 5\n${plainStyle(style)}`;
}

export function towerText(at: Point, heading: number, style: Style): string {
  return `[[tower]]\nat_mm = ${pointText(at)}\nheading_deg = ${writeValue(heading)}\nlayers = 8\n${plainStyle(style)}`;
}

/** How many flat bricks fill the rectangle between two corners, along x and across: two of each at least. */
export function pyramidCounts(a: Point, b: Point, size: { height: number; width: number }): [number, number] {
  return [Math.max(2, Math.round(Math.abs(b.x - a.x) / size.height)), Math.max(2, Math.round(Math.abs(b.y - a.y) / size.width))];
}
export function pyramidText(a: Point, b: Point, style: Style, size: { height: number; width: number }): string {
  const [along, across] = pyramidCounts(a, b, size);
  return `[[pyramid]]\nat_mm = ${pointText(middle(a, b))}\ncount_along = ${along}\ncount_across = ${across}\n${plainStyle(style)}`;
}

/** A stroke of 200 mm rolls it at a metre a second. */
export function ballSpeed(length: number): number {
  return Math.max(0.05, Math.round(length / 10) / 20);
}
export function ballText(at: Point, heading: number, speed: number, style: Style): string {
  return `[[ball]]\nat_mm = ${pointText(at)}\nheading_deg = ${writeValue(heading)}\nspeed_m_s = ${writeValue(speed)}\ndiameter_mm = 30\ncolor = ${writeValue(style.color)}\n`;
}

/** Nearly a whole circle: a pitch is left open, so that the last brick does not stand on the first. */
export function circlePoints(middle: Point, rim: Point, pitch: number): Point[] {
  const radius = Math.max(distance(middle, rim), 2.2 * pitch);
  const start = Math.atan2(rim.y - middle.y, rim.x - middle.x);
  const whole = 2 * Math.PI - (1.5 * pitch) / radius;
  const n = Math.max(16, Math.ceil(whole / 0.26));
  return Array.from({ length: n + 1 }, (_, i) => {
    const angle = start + (whole * i) / n;
    return { x: middle.x + radius * Math.cos(angle), y: middle.y + radius * Math.sin(angle) };
  });
}

/** From the rim inwards, a lane's breadth closer each turn, to where bricks could not turn any tighter. */
export function spiralPoints(middle: Point, rim: Point, lane: number): Point[] {
  const outer = Math.max(distance(middle, rim), 2.4 * lane);
  const start = Math.atan2(rim.y - middle.y, rim.x - middle.x);
  const inner = 1.25 * lane;
  const turns = Math.max(0.5, (outer - inner) / lane);
  const n = Math.ceil(turns * 20);
  return Array.from({ length: n + 1 }, (_, i) => {
    const turn = (turns * i) / n;
    const radius = outer - lane * turn;
    const angle = start + 2 * Math.PI * turn;
    return { x: middle.x + radius * Math.cos(angle), y: middle.y + radius * Math.sin(angle) };
  });
}

/** One swing to the left and one to the right between two places. */
export function essPoints(a: Point, b: Point): Point[] {
  const length = distance(a, b);
  const [ux, uy] = length > 0 ? [(b.x - a.x) / length, (b.y - a.y) / length] : [1, 0];
  return Array.from({ length: 13 }, (_, i) => {
    const part = i / 12;
    const aside = 0.2 * length * Math.sin(2 * Math.PI * part);
    return { x: a.x + ux * length * part - uy * aside, y: a.y + uy * length * part + ux * aside };
  });
}

/**
 * The two arms of a split after a brick: each begins a pitch ahead and half a width to its side, and swings outwards.
 * @param heading Of the brick [deg].
 */
export function splitArms(at: Point, heading: number, pitch: number, width: number): [Point[], Point[]] {
  const [c, s] = [Math.cos((heading * Math.PI) / 180), Math.sin((heading * Math.PI) / 180)];
  const arm = (side: number): Point[] =>
    [[1, 0.54], [3, 0.62], [6, 1.1], [10, 2.6], [14, 5], [18, 7.6]].map(([ahead, aside]) => {
      const [x, y] = [ahead * pitch, side * aside * width];
      return { x: at.x + c * x - s * y, y: at.y + s * x + c * y };
    });
  return [arm(1), arm(-1)];
}

/** Fewer points for a line drawn by hand, none further off than `tolerance`; then evened out, for a hand trembles. */
export function smoothed(drawn: readonly Point[], tolerance: number): Point[] {
  if (drawn.length < 3) return [...drawn];
  const even = resample(drawn, 4 * tolerance);
  const calm = even.map((p, i) => (i === 0 || i === even.length - 1 ? p : mean(even.slice(Math.max(0, i - 2), i + 3))));
  const kept = simplify(calm, tolerance);
  return spaced(kept, 6 * tolerance);
}

function mean(points: readonly Point[]): Point {
  return { x: points.reduce((sum, p) => sum + p.x, 0) / points.length, y: points.reduce((sum, p) => sum + p.y, 0) / points.length };
}

function resample(points: readonly Point[], step: number): Point[] {
  const out = [points[0]];
  for (const p of points) if (distance(out[out.length - 1], p) >= step) out.push(p);
  const last = points[points.length - 1];
  if (distance(out[out.length - 1], last) > 0.5 * step || out.length < 2) out.push(last);
  return out;
}

/** Douglas and Peucker's way: keeps the farthest point of each stretch while it is too far off. */
function simplify(points: readonly Point[], tolerance: number): Point[] {
  if (points.length < 3) return [...points];
  const [a, b] = [points[0], points[points.length - 1]];
  const length = distance(a, b) || 1;
  let [most, at] = [0, 0];
  for (let i = 1; i + 1 < points.length; i++) {
    const off = Math.abs((b.x - a.x) * (points[i].y - a.y) - (b.y - a.y) * (points[i].x - a.x)) / length;
    if (off > most) [most, at] = [off, i];
  }
  if (most <= tolerance) return [a, b];
  return [...simplify(points.slice(0, at + 1), tolerance), ...simplify(points.slice(at), tolerance).slice(1)];
}

/** Without points that crowd their neighbour. */
function spaced(points: readonly Point[], least: number): Point[] {
  return points.filter((p, i) => i === 0 || i === points.length - 1 || distance(points[i - 1], p) >= least || i % 2 === 0);
}
