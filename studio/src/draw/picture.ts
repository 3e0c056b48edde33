/** An image as a field of bricks: its pixels, how far its bricks stand apart, the part of the layout file, and how it looks from above. */

import type { Picture } from '../engine/engine.ts';
import { writeValue } from './toml.ts';
import type { Point } from './parts.ts';

export interface Pixels {
  pixels: Uint8ClampedArray<ArrayBuffer>;
  width: number;
  height: number;
}

/** What starts the rows: a push for each, or a line of bricks along their heads. */
export type Starter = 'pushes' | 'line';

/** How far the bricks stand apart, all in mm. */
export interface Spacing {
  thickness: number;
  width: number;
  gap: number;
  rowPitch: number;
}

/** More than there are bricks in any picture that a page shows; the rest would only take time. */
const kMostPixels = 1600;

export const isImage = (file: File): boolean => file.type.startsWith('image/') || /\.(png|jpe?g|webp)$/i.test(file.name);

/** The image as it is to be seen: turned as its camera says. @throws where the browser knows no such image. */
export async function pixelsOf(file: Blob): Promise<Pixels> {
  const bitmap = await createImageBitmap(file);
  const scale = Math.min(1, kMostPixels / Math.max(bitmap.width, bitmap.height));
  const [width, height] = [bitmap.width, bitmap.height].map((length) => Math.max(1, Math.round(length * scale)));
  const context = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true }) as OffscreenCanvasRenderingContext2D;
  context.imageSmoothingQuality = 'high';
  context.drawImage(bitmap, 0, 0, width, height);
  bitmap.close();
  return { pixels: context.getImageData(0, 0, width, height).data as Uint8ClampedArray<ArrayBuffer>, width, height };
}

/** Close together, as builders set a field; a line that lets rows go needs room to turn into each. */
export function spacingOf(size: { width: number; thickness: number }, starter: Starter): Spacing {
  const { width, thickness } = size;
  if (starter === 'pushes') return { thickness, width, gap: (8.5 / 7.5) * thickness, rowPitch: (4 / 3) * width };
  const gap = 2.2 * thickness;
  return { thickness, width, gap, rowPitch: Math.max(3 * width + 4, 2.5 * (thickness + gap) + 4) };
}

/** The part that shows a picture. @param from The foot of its first brick, at the lower left [mm]. */
export function pictureFieldText(picture: Picture, spacing: Spacing, starter: Starter, from: Point, kind: string): string {
  const start = starter === 'pushes' ? 'starter = "pushes"\nangular_speed_rad_s = 10\n' : 'starter = "line"\ncolor = "#5d6d7e"\n';
  const head = `[[field]]\nfrom_mm = ${writeValue([from.x, from.y])}\ngap_mm = ${writeValue(spacing.gap)}\nrow_pitch_mm = ${writeValue(spacing.rowPitch)}\n`;
  return `${head}${start}${kind ? `kind = ${writeValue(kind)}\n` : ''}${picture.text}`;
}

/** Draws the bricks from above into a canvas, in true proportions and as large as fits. @param most Its largest size [CSS px]. */
export function drawPicture(canvas: HTMLCanvasElement, picture: Picture, colors: readonly string[], spacing: Spacing, most: { width: number; height: number }): void {
  const pitch = spacing.thickness + spacing.gap;
  const [wide, high] = [picture.count * pitch, picture.rows * spacing.rowPitch];
  const fit = Math.min(most.width / wide, most.height / high);
  canvas.style.width = `${Math.max(1, wide * fit)}px`;
  canvas.style.height = `${Math.max(1, high * fit)}px`;
  const scale = fit * devicePixelRatio;
  [canvas.width, canvas.height] = [wide, high].map((length) => Math.max(1, Math.round(length * scale)));
  const context = canvas.getContext('2d') as CanvasRenderingContext2D;
  const [w, h] = [Math.max(1, spacing.thickness * scale), Math.max(1, spacing.width * scale)];
  // Where there is no room for gaps the bricks fill it: from afar one sees no table between them.
  const whole = pitch * scale < 3;
  picture.cells.forEach((color, i) => {
    const [x, y] = [(i % picture.count) * pitch * scale, Math.floor(i / picture.count) * spacing.rowPitch * scale];
    context.fillStyle = colors[color];
    if (whole) context.fillRect(x, y, pitch * scale + 0.5, spacing.rowPitch * scale + 0.5);
    else context.fillRect(x + 0.5 * (pitch * scale - w), y + 0.5 * (spacing.rowPitch * scale - h), w, h);
  });
}
