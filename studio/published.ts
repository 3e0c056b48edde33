/**
 * Measured front speeds of ../validation, read while the page is built: the same files that `topple validate` judges by, so that no number
 * stands in two places. A source is taken where its figure says what its numbers are.
 */

import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Plugin } from 'vite';
import type { PublishedSource, PublishedX, PublishedY } from './src/recording/published.ts';
import { TomlFile, type Block } from './src/draw/toml.ts';

const kX: Record<string, PublishedX> = { 'Gap [mm]': 'gap', 'Pitch / height': 'pitch_per_height', 'Gap / height': 'gap_per_height' };
const kY: Record<string, PublishedY> = {
  'Front speed [m/s]': 'speed',
  'Front speed / √(g × height)': 'speed_per_root',
  'Time from contact to contact [ms]': 'time_per_brick',
};

/** @param folder With a folder for each source. */
export function readPublished(folder: string): PublishedSource[] {
  return readdirSync(folder).sort().flatMap((name) => {
    const [source, row] = ['source.toml', 'row.toml'].map((file) => join(folder, name, file));
    return existsSync(source) && existsSync(row) ? sourceOf(new TomlFile(readFileSync(source, 'utf8')), new TomlFile(readFileSync(row, 'utf8'))) : [];
  });
}

function sourceOf(source: TomlFile, row: TomlFile): PublishedSource[] {
  const head = source.blocks[0];
  const figure = source.table('figure');
  const [x, y] = [kX[figure?.string('x_label') ?? ''], kY[figure?.string('y_label') ?? '']];
  const kind = row.list('kind')[0];
  if (head.string('kind') !== 'experiment' || !x || !y || !kind) return [];
  const [height, thickness] = [kind.number('height_mm', NaN) / 1000, kind.number('thickness_mm', NaN) / 1000];
  const series = source.blocks.flatMap((block, at) => (block.isList && block.name === 'points' ? [seriesOf(block, factorsAfter(source.blocks, at))] : []));
  return [{ name: head.string('title').split(':')[0], x, y, height, thickness, series }];
}

/** Of the readings that belong to the points before them. */
function factorsAfter(blocks: readonly Block[], at: number): number[] {
  const factors: number[] = [];
  for (let i = at + 1; i < blocks.length && blocks[i].name === 'points.reading'; i++) factors.push(blocks[i].number('factor', 1));
  return factors.length ? factors : [1];
}

function seriesOf(points: Block, factors: number[]): PublishedSource['series'][number] {
  const numbers = (key: string): number[] => (points.get(key) as number[] | undefined) ?? [];
  const [x, y, error] = [numbers('x'), numbers('y'), numbers('error')];
  const share = points.number('relative_error', 0);
  const bar = (i: number): number => error[i] ?? share * y[i];
  return {
    x,
    low: y.map((value, i) => Math.min(...factors) * (value - bar(i))),
    high: y.map((value, i) => Math.max(...factors) * (value + bar(i))),
  };
}

/** `import published from 'virtual:published'`. */
export function publishedSources(folder: string): Plugin {
  const id = 'virtual:published';
  return {
    name: 'published-sources',
    resolveId: (asked) => (asked === id ? `\0${id}` : undefined),
    load: (asked) => (asked === `\0${id}` ? `export default ${JSON.stringify(readPublished(folder))};` : undefined),
  };
}
