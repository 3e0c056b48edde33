/** What the pointer does on the table while one draws: strokes that become parts, parts that are dragged, points that are pulled. In mm. */

import type { Stage } from '../player/stage.svelte.ts';
import { headingOf, nameOf, paintBrick, partsOf, pointsOf, setHeading, setPoints, sizeOf, thicknessOf, type Point } from './parts.ts';
import * as shapes from './shapes.ts';
import type { Studio } from './studio.svelte.ts';

/** Bricks' lanes in a spiral stand so far apart [mm]: a fallen brick does not reach the next lane. */
const kLane = 78;
const kSnapPixels = 18;
/** How long a part is that is put down by a key [mm]. */
const kPutDown = 300;

/** A point that one can pull. */
export interface Grip {
  part: number;
  /** Which point of a curve; of a row 0 its start, 1 its end. */
  point: number;
  at: Point;
}

export class Hand {
  /** The stroke so far, for its drawing over the view. */
  stroke = $state.raw<Point[]>([]);
  /** Corners of the rectangle that chooses, in CSS pixels of the view. */
  frame = $state.raw<{ x: number; y: number; w: number; h: number } | null>(null);
  /** Beside the pointer: what is being made. */
  words = $state('');
  /** Where a stroke would catch. */
  caught = $state.raw<Point | null>(null);
  private from: Point | null = null;
  private last: Point | null = null;
  private pixel = { x: 0, y: 0 };
  private deed: 'stroke' | 'drag' | 'frame' | 'grip' | 'none' = 'none';
  private grip: Grip | null = null;
  private moved = false;
  /** The brick that the brush touched last. */
  private painted = -1;

  constructor(
    private readonly studio: Studio,
    private readonly stage: Stage,
  ) {}

  get busy(): boolean {
    return this.deed !== 'none';
  }

  /** Of the kind that new parts are given [mm]. */
  private get size(): { height: number; width: number; thickness: number } {
    return sizeOf(this.studio.file, this.studio.style.kind);
  }
  private get pitch(): number {
    return this.studio.style.gap + this.size.thickness;
  }

  /** @param x, y In CSS pixels from the view's upper left corner. */
  place(x: number, y: number): Point | null {
    const at = this.stage.view?.tablePoint(x, y);
    return at ? { x: at.x * 1000, y: at.y * 1000 } : null;
  }

  down(x: number, y: number, event: PointerEvent): void {
    const { studio } = this;
    const at = this.place(x, y);
    this.pixel = { x, y };
    this.moved = false;
    if (!at) return;
    const brick = this.stage.view?.pick(x, y) ?? -1;
    const start = event.altKey ? at : this.snapped(at);
    this.from = start;
    this.last = at;
    switch (studio.tool) {
      case 'select':
        return this.take(brick, event.shiftKey || event.ctrlKey || event.metaKey);
      case 'push':
        if (brick >= 0) studio.pushBrick(brick);
        return;
      case 'brush':
        this.painted = -1;
        this.paint(brick);
        this.deed = 'drag';
        return;
      case 'split':
        return this.split(start);
      case 'measure':
        return;
      default:
        this.deed = 'stroke';
        this.stroke = [start];
    }
  }

  private take(brick: number, more: boolean): void {
    const { studio } = this;
    const part = brick >= 0 ? studio.partOf(brick) : -1;
    if (part < 0) {
      if (!more) studio.chosen = [];
      this.deed = 'frame';
      return;
    }
    if (more) studio.chosen = studio.chosen.includes(part) ? studio.chosen.filter((one) => one !== part) : [...studio.chosen, part];
    else if (!studio.chosen.includes(part)) studio.chosen = [part];
    this.deed = 'drag';
  }

  /** Colours the brick under the brush. */
  private paint(brick: number): void {
    const { studio } = this;
    const index = brick >= 0 ? studio.partOf(brick) : -1;
    const span = studio.spanOf(index);
    if (!span || brick === this.painted) return;
    this.painted = brick;
    studio.edit((file) => {
      const part = partsOf(file)[index];
      if (part.name === 'brick' || part.name === 'ball') part.set('color', studio.style.color);
      else paintBrick(part, brick - span.first, studio.style.color);
    }, 'brush');
  }

  takeGrip(grip: Grip): void {
    this.grip = grip;
    this.deed = 'grip';
    this.from = grip.at;
  }

  move(x: number, y: number, event: PointerEvent): void {
    const at = this.place(x, y);
    if (this.deed === 'none' || !at || !this.from || !this.last) {
      if (at && this.deed === 'none' && !['select', 'push', 'measure', 'brush'].includes(this.studio.tool)) this.showCatch(at, event.altKey);
      return;
    }
    if (!this.moved && Math.hypot(x - this.pixel.x, y - this.pixel.y) < 4) return;
    this.moved = true;
    if (this.deed === 'frame') {
      this.frame = { x: Math.min(x, this.pixel.x), y: Math.min(y, this.pixel.y), w: Math.abs(x - this.pixel.x), h: Math.abs(y - this.pixel.y) };
    } else if (this.deed === 'grip') this.pull(at, event.altKey);
    else if (this.deed === 'drag' && this.studio.tool === 'brush') this.paint(this.stage.view?.pick(x, y) ?? -1);
    else if (this.deed === 'drag') {
      this.studio.move(at.x - this.last.x, at.y - this.last.y, 'drag');
      this.last = at;
    } else this.extend(event.altKey ? at : this.snappedEnd(at, event.shiftKey));
  }

  private showCatch(at: Point, free: boolean): void {
    const start = free ? at : this.snapped(at);
    this.caught = start === at ? null : start;
  }

  private extend(at: Point): void {
    const from = this.from as Point;
    const { tool, style } = this.studio;
    const length = Math.hypot(at.x - from.x, at.y - from.y);
    const count = Math.floor(length / this.pitch + 1e-6) + 1;
    this.stroke = tool === 'curve' ? [...this.stroke, at] : this.outline(from, at);
    const size = `${Math.round(length)} mm`;
    if (tool === 'row') this.words = `${size}, ${count} bricks, gap ${style.gap} mm`;
    else if (tool === 'circle' || tool === 'spiral') this.words = `radius ${size}`;
    else if (tool === 'field') this.words = `${Math.round(Math.abs(at.x - from.x))} × ${Math.round(Math.abs(at.y - from.y))} mm`;
    else if (tool === 'wall') this.words = `${shapes.wallCount(from, at, this.size)} bricks wide, 5 high`;
    else if (tool === 'pyramid') this.words = `${shapes.pyramidCounts(from, at, this.size).join(' × ')} bricks`;
    else if (tool === 'ball') this.words = `rolls at ${shapes.ballSpeed(length).toFixed(2)} m/s`;
    else if (tool === 'tower') this.words = `heading ${Math.round((Math.atan2(at.y - from.y, at.x - from.x) * 180) / Math.PI)}°`;
    else if (tool === 'curve') this.words = `${this.stroke.length > 1 ? Math.round(lengthOf(this.stroke)) : 0} mm`;
    else this.words = size;
  }

  private outline(from: Point, at: Point): Point[] {
    switch (this.studio.tool) {
      case 'circle':
        return shapes.circlePoints(from, at, this.pitch);
      case 'spiral':
        return shapes.spiralPoints(from, at, kLane);
      case 'ess':
        return shapes.essPoints(from, at);
      case 'field':
      case 'pyramid':
        return [from, { x: at.x, y: from.y }, at, { x: from.x, y: at.y }, from];
      default:
        return [from, at];
    }
  }

  up(): void {
    const { studio, deed } = this;
    this.deed = 'none';
    if (deed === 'stroke') this.finishStroke();
    if (deed === 'frame' && this.frame) this.chooseIn(this.frame);
    if (deed === 'drag' || deed === 'grip') studio.endGroup();
    this.cancel();
  }

  cancel(): void {
    this.deed = 'none';
    this.stroke = [];
    this.frame = null;
    this.words = '';
    this.caught = null;
    this.grip = null;
  }

  /** Without a pointer: what the tool draws, in a usual size, on from the end of the last part or in the middle of the view. */
  putDown(): void {
    const { studio, stage } = this;
    const { tool } = studio;
    const canvas = stage.view?.canvas;
    if (!canvas || ['select', 'push', 'brush', 'measure'].includes(tool)) return;
    const end = this.lastEnd();
    if (tool === 'split') return end ? this.split(end.foot) : undefined;
    const heading = end ? (end.heading * Math.PI) / 180 : 0;
    const along = (from: Point, far: number, across = 0): Point => ({
      x: from.x + far * Math.cos(heading) - across * Math.sin(heading), y: from.y + far * Math.sin(heading) + across * Math.cos(heading),
    });
    const middle = this.place(canvas.clientWidth / 2, canvas.clientHeight / 2) ?? { x: 0, y: 0 };
    const from = end ? along(end.foot, this.pitch) : along(middle, -kPutDown / 2);
    const to = along(from, kPutDown, tool === 'field' || tool === 'pyramid' ? kPutDown / 2 : 0);
    this.from = from;
    this.moved = true;
    this.stroke = tool === 'curve' ? [from, along(from, kPutDown / 2, kPutDown / 6), to] : this.outline(from, to);
    this.finishStroke();
    this.cancel();
  }

  /** Of the last part that goes somewhere: its last brick. */
  private lastEnd(): { foot: Point; heading: number } | null {
    const recording = this.studio.layout?.recording;
    const part = recording?.parts.at(-1);
    if (!recording || !part || this.studio.empty) return null;
    const brick = part.first + part.count - 1;
    return { foot: this.footOf(brick), heading: (recording.bricks.heading[brick] * 180) / Math.PI };
  }

  private finishStroke(): void {
    const { studio, stroke } = this;
    const { style, tool } = studio;
    const from = this.from as Point;
    const to = tool === 'field' || tool === 'pyramid' ? stroke[2] : stroke[stroke.length - 1];
    const length = this.moved && to ? Math.hypot(to.x - from.x, to.y - from.y) : 0;
    const heading = length > 10 ? (Math.atan2(to.y - from.y, to.x - from.x) * 180) / Math.PI : 0;
    if (tool === 'brick') return studio.add(shapes.brickText(from, heading, style));
    if (tool === 'tower') return studio.add(shapes.towerText(from, heading, style));
    if (tool === 'ball') return studio.add(shapes.ballText(from, heading, length > 10 ? shapes.ballSpeed(length) : 0.5, style));
    if (!this.moved || !to) return;
    if (tool === 'wall') studio.add(shapes.wallText(from, to, style, this.size));
    else if (tool === 'pyramid') studio.add(shapes.pyramidText(from, to, style, this.size));
    else if (tool === 'row') studio.add(shapes.rowText(from, to, style, this.pitch));
    else if (tool === 'field') studio.add(shapes.fieldText(from, to, style, this.pitch, this.size.width));
    else {
      const points = tool === 'curve' ? shapes.smoothed(stroke, 8) : stroke;
      if (points.length > 1 && lengthOf(points) > this.pitch) studio.add(shapes.curveText(points, style));
    }
  }

  private split(at: Point): void {
    const end = this.endNear(at, 60);
    if (!end) return;
    const { studio } = this;
    const arms = shapes.splitArms(end.foot, end.heading, this.pitch, this.size.width);
    studio.add(...arms.map((arm) => shapes.curveText(arm, studio.style)));
  }

  private chooseIn(frame: { x: number; y: number; w: number; h: number }): void {
    const { studio, stage } = this;
    const found = new Set<number>(studio.chosen);
    const count = stage.playhead?.recording.bricks.count ?? 0;
    const step = Math.max(1, Math.floor(count / 4000));
    for (let brick = 0; brick < count; brick += step) {
      const outline = stage.view?.outline(brick);
      if (!outline) continue;
      const [x, y] = [0, 1].map((axis) => outline.points.reduce((sum, p) => sum + p[axis] / outline.points.length, 0));
      if (x < frame.x || x > frame.x + frame.w || y < frame.y || y > frame.y + frame.h) continue;
      const part = studio.partOf(brick);
      if (part >= 0) found.add(part);
    }
    studio.chosen = [...found].sort((a, b) => a - b);
  }

  /** Points of the chosen parts that can be pulled. */
  grips(): Grip[] {
    const { studio } = this;
    const file = studio.file;
    const parts = partsOf(file);
    return studio.chosen.flatMap((index): Grip[] => {
      const part = parts[index];
      if (!part) return [];
      const points = pointsOf(part);
      const all = points.length > 40 ? points.filter((_, i) => i % Math.ceil(points.length / 40) === 0) : points;
      const grips = all.map((at) => ({ part: index, point: points.indexOf(at), at }));
      const span = part.name === 'row' ? studio.spanOf(index) : null;
      if (span && span.last > span.first) grips.push({ part: index, point: 1, at: this.footOf(span.last) });
      return grips;
    });
  }

  private footOf(brick: number): Point {
    const foot = this.studio.layout?.recording.bricks.foot;
    return foot ? { x: foot[3 * brick] * 1000, y: foot[3 * brick + 1] * 1000 } : { x: 0, y: 0 };
  }

  private pull(at: Point, free: boolean): void {
    const grip = this.grip as Grip;
    this.studio.edit((file) => {
      const part = partsOf(file)[grip.part];
      const points = pointsOf(part);
      if (part.name === 'row' && grip.point === 1) {
        const pitch = part.number('pitch_mm', part.number('gap_mm', 16.5) + thicknessOf(file, part));
        const heading = (Math.atan2(at.y - points[0].y, at.x - points[0].x) * 180) / Math.PI;
        setHeading(part, free ? heading : Math.round(heading));
        part.remove('length_mm');
        part.set('count', Math.max(1, Math.floor(Math.hypot(at.x - points[0].x, at.y - points[0].y) / pitch + 0.5) + 1));
        this.words = `${part.number('count', 1)} bricks, ${headingOf(part).toFixed(1)}°`;
        return;
      }
      points[grip.point] = free ? at : { x: Math.round(at.x), y: Math.round(at.y) };
      setPoints(part, points);
      this.words = `${Math.round(at.x)}, ${Math.round(at.y)} mm`;
    }, `grip ${grip.part} ${grip.point}`);
  }

  /** The end of a part near a place: its last brick and the way that heads. */
  private endNear(at: Point, within: number): { foot: Point; heading: number } | null {
    const { studio } = this;
    const layout = studio.layout;
    if (!layout) return null;
    let best: { foot: Point; heading: number } | null = null;
    let least = within;
    for (const part of layout.recording.parts) {
      const brick = part.first + part.count - 1;
      const foot = this.footOf(brick);
      const away = Math.hypot(foot.x - at.x, foot.y - at.y);
      if (away >= least) continue;
      least = away;
      best = { foot, heading: (layout.recording.bricks.heading[brick] * 180) / Math.PI };
    }
    return best;
  }

  /** One pitch past the end of a part that is near, so that a stroke goes on from it; else the place itself. */
  private snapped(at: Point): Point {
    const scale = this.millimetresPerPixel(at);
    const end = this.endNear(at, Math.max(30, kSnapPixels * scale));
    if (!end) return at;
    const [c, s] = [Math.cos((end.heading * Math.PI) / 180), Math.sin((end.heading * Math.PI) / 180)];
    return { x: end.foot.x + c * this.pitch, y: end.foot.y + s * this.pitch };
  }

  private millimetresPerPixel(at: Point): number {
    const { x, y } = this.pixel;
    const beside = this.place(x + 8, y);
    return beside ? Math.hypot(beside.x - at.x, beside.y - at.y) / 8 : 1;
  }

  /** What has a heading keeps to whole degrees, with Shift to steps of 15. */
  private snappedEnd(at: Point, shift: boolean): Point {
    const { tool } = this.studio;
    const from = this.from as Point;
    if (!['row', 'wall', 'tower', 'ball', 'brick'].includes(tool) && !shift) return at;
    const length = Math.hypot(at.x - from.x, at.y - from.y);
    const step = (shift ? 15 : 1) * (Math.PI / 180);
    const angle = Math.round(Math.atan2(at.y - from.y, at.x - from.x) / step) * step;
    return tool === 'curve' || tool === 'field' || tool === 'pyramid' ? at : { x: from.x + length * Math.cos(angle), y: from.y + length * Math.sin(angle) };
  }

  /** "Curve 1, 84 bricks" of each chosen part. */
  spoken(): string {
    const file = this.studio.file;
    const parts = partsOf(file);
    return this.studio.chosen
      .map((index) => {
        const span = this.studio.spanOf(index);
        return parts[index] ? `${nameOf(file, parts[index])}${span ? `, ${span.last - span.first + 1} bricks` : ''}` : '';
      })
      .join('; ');
  }
}

function lengthOf(points: readonly Point[]): number {
  let sum = 0;
  for (let i = 1; i < points.length; i++) sum += Math.hypot(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y);
  return sum;
}
