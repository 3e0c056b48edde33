/** The forces at contacts over the pictures of a film: the same arrows as in the page, drawn into a sheet with each picture. */

import { arrowPaths } from '../forces/arrow_paths.ts';
import { Forces } from '../forces/forces.svelte.ts';
import type { Player } from '../player/player.svelte.ts';
import type { View } from '../view/view.ts';

/** Of the page's drawing; styles of arrows.svelte. */
const kColors = { floor: '#0b5cad', brick: '#b3261e' };
/** A film this high has lines as thick as the page [px]. */
const kUsualHeight = 720;

export class ArrowLayer {
  readonly sheet: HTMLCanvasElement;
  private readonly forces = new Forces();
  private readonly pen: CanvasRenderingContext2D;

  constructor(
    private readonly player: Player,
    private readonly view: View,
    width: number,
    height: number,
  ) {
    this.sheet = Object.assign(document.createElement('canvas'), { width, height });
    this.pen = this.sheet.getContext('2d')!;
    this.forces.on = true;
  }

  /** Until the forces of a moment are known. @throws Error with the reason why there are none. */
  async reach(time: number): Promise<void> {
    for (;;) {
      this.forces.want(this.player.recording!, time);
      if (this.forces.problem) throw new Error(this.forces.problem);
      if (this.forces.at(time)) return;
      await new Promise((resume) => setTimeout(resume, 5));
    }
  }

  /** The view's picture as it is now, and the arrows of a moment that was reached. */
  draw(time: number): void {
    const { pen, sheet, view, player } = this;
    pen.drawImage(view.canvas, 0, 0, sheet.width, sheet.height);
    const scale = Math.max(0.5, Math.min(sheet.width, sheet.height) / kUsualHeight);
    const project = (place: Parameters<View['pixelOf']>[0]): ReturnType<View['pixelOf']> => view.pixelOf(place, sheet.width, sheet.height);
    const paths = arrowPaths(player.recording!, this.forces.at(time)?.contacts ?? [], player.chosen, project, scale);
    pen.lineCap = pen.lineJoin = 'round';
    for (const name of ['floor', 'brick'] as const) {
      const { lines, heads, points } = paths[name];
      this.stroke(lines + points, 'rgb(255 255 255 / 60%)', 4.5 * scale);
      this.stroke(lines, kColors[name], 2 * scale);
      pen.fillStyle = kColors[name];
      pen.fill(new Path2D(heads));
      this.stroke(heads, '#fff', 0.75 * scale);
      this.stroke(points, kColors[name], 5 * scale);
    }
  }

  private stroke(path: string, color: string, width: number): void {
    this.pen.strokeStyle = color;
    this.pen.lineWidth = width;
    this.pen.stroke(new Path2D(path));
  }

  close(): void {
    this.forces.toggle();
  }
}
