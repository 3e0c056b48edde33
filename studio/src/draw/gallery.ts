/** Ten layouts worth looking at, made with the drawing tools' own shapes. */

import { brickText, circlePoints, curveText, essPoints, fieldText, rowText, spiralPoints, splitArms, type Style } from './shapes.ts';

export interface Scene {
  name: string;
  /** One sentence. */
  about: string;
  text: string;
}

const kGap = 16.5;
const kPitch = 24;
const kWidth = 24;
const style = (color: string, colorTo = ''): Style => ({ gap: kGap, color, colorTo, kind: '' });

const head = (title: string): string => `title = "${title}"\n\n[[push]]\nbrick = 0\nangular_speed_rad_s = 4\n\n`;
const file = (title: string, ...parts: string[]): string => `${head(title)}${parts.join('\n')}\n[model]\nname = "rigid"\n`;

const at = (x: number, y: number): { x: number; y: number } => ({ x, y });

function forked(): string {
  const [left, right] = splitArms(at(23 * kPitch, 0), 0, kPitch, kWidth);
  return file('A fork', rowText(at(0, 0), at(23 * kPitch, 0), style('#d92b2b', '#f0821e'), kPitch), curveText(left, style('#f0821e', '#f2b928')), curveText(right, style('#f0821e', '#c2185b')));
}

function essWithSplit(): string {
  const line = essPoints(at(0, 0), at(1200, 0));
  const end = line[line.length - 1];
  const before = line[line.length - 2];
  const heading = (Math.atan2(end.y - before.y, end.x - before.x) * 180) / Math.PI;
  const [left, right] = splitArms(end, heading, kPitch, kWidth);
  return file('An S that forks', curveText(line, style('#7832be', '#1478c8')), curveText(left, style('#1478c8', '#17a398')), curveText(right, style('#1478c8', '#c2185b')));
}

function flower(): string {
  const colors = ['#d92b2b', '#f0821e', '#f2b928', '#3faa46', '#1478c8', '#7832be'];
  const points = Array.from({ length: 97 }, (_, i) => {
    const angle = (2 * Math.PI * i) / 96 - 0.02 * (i / 96);
    const radius = 520 + 130 * Math.cos(6 * angle);
    return at(radius * Math.cos(angle), radius * Math.sin(angle));
  }).slice(0, 96);
  return file('A flower of six petals', curveText(points, style(colors[0], colors[4])));
}

function growing(): string {
  const sizes = [24, 32, 43, 57, 76, 101];
  const names = ['tiny', 'small', 'domino', 'big', 'giant', 'titan'];
  const colors = ['#f2b928', '#f0821e', '#d92b2b', '#7832be', '#1478c8', '#17a398'];
  const kinds = sizes.map((h, i) => `[[kind]]\nname = "${names[i]}"\nheight_mm = ${h}\nwidth_mm = ${h / 2}\nthickness_mm = ${(h * 0.156).toFixed(2)}\ncolor = "${colors[i]}"\n`);
  let x = 0;
  const rows = sizes.map((h, i) => {
    const gap = 0.34 * h;
    const pitch = gap + h * 0.156;
    const text = `[[row]]\nfrom_mm = [${x.toFixed(2)}, 0]\ncount = 8\ngap_mm = ${gap.toFixed(2)}\nkind = "${names[i]}"\n`;
    x += 8 * pitch + 0.5 * ((sizes[i + 1] ?? h) - h) * 0.156;
    return text;
  });
  return file('Each a third larger', ...kinds, ...rows);
}

function snake(): string {
  const points = Array.from({ length: 61 }, (_, i) => at(i * 24, 150 * Math.sin((2 * Math.PI * i) / 20)));
  return file('A snake', curveText(points, style('#3faa46', '#f2b928')));
}

export const kGallery: Scene[] = [
  { name: 'A straight row', about: 'Fifty dominoes, red to blue: the plainest run there is.', text: file('A straight row', rowText(at(0, 0), at(49 * kPitch, 0), style('#d92b2b', '#2b5bd9'), kPitch)) },
  { name: 'An S that forks', about: 'One wave becomes two.', text: essWithSplit() },
  { name: 'A spiral', about: 'The wave runs inwards until there is no room left.', text: file('A spiral', curveText(spiralPoints(at(0, 0), at(420, 0), 78), style('#7832be', '#f0821e'))) },
  { name: 'A ring', about: 'Round once, back to where it began.', text: file('A ring', curveText(circlePoints(at(0, 0), at(340, 0), kPitch), style('#17a398', '#7832be'))) },
  { name: 'A fork', about: 'A row that lets two curves go.', text: forked() },
  { name: 'A field', about: 'A line along the heads of eight rows lets each go in turn.', text: file('A field', fieldText(at(0, 0), at(520, 560), style('#1478c8', '#3faa46'), kPitch, kWidth)) },
  { name: 'A flower', about: 'Six petals in one line.', text: flower() },
  { name: 'Each a third larger', about: 'Six sizes, from 24 to 101 mm: a small push becomes a large one.', text: growing() },
  { name: 'A snake', about: 'Three bends to each side.', text: snake() },
  {
    name: 'Where it stops', about: 'One gap is too wide. What would you change?',
    text: file('Where it stops', rowText(at(0, 0), at(9 * kPitch, 0), style('#d92b2b'), kPitch), rowText(at(10 * kPitch + 44, 0), at(19 * kPitch + 44, 0), style('#f0821e'), kPitch), brickText(at(20 * kPitch + 44, 0), 0, style('#3faa46'))),
  },
];
