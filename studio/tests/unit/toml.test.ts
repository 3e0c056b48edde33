/** Layout files that are changed in one place and stay as they were in all others. */

import { readdirSync, readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { describe, expect, test } from 'vitest';
import { parseValue, TomlFile, writeValue } from '../../src/draw/toml.ts';

const kScenes = fileURLToPath(new URL('../../../scenes/', import.meta.url));

describe('a layout file', () => {
  test.each(readdirSync(kScenes).filter((name) => name.endsWith('.toml')))('%s comes out as it went in', (name) => {
    const text = readFileSync(kScenes + name, 'utf8');
    expect(new TomlFile(text).text).toBe(text);
  });

  const text = `# a title
title = "Two # rows" # kept
unknown = {a = 1}

# first
[[row]]
count = 3 # three
points_mm = [
  [1, 2], # one
  [3, 4],
]
text = """
[[row]]
count = 9
"""

[later]
x = [[1], [2]]
[[row]]
count=5`;

  test('a picture stays as it is while keys around it change, whatever signs it is drawn with', () => {
    const picture = 'palette = { "#" = "#000000", "[" = "#ffffff" }\npicture = [\n  "#[#",\n  "[[#",\n]\n';
    const file = new TomlFile(`[[field]]\ngap_mm = 8\n${picture}rows = 2\n\n[model]\nname = "rigid"\n`);
    expect(file.blocks.map((block) => block.name)).toEqual(['field', 'model']);
    file.list('field')[0].set('gap_mm', 9);
    file.list('field')[0].set('heading_deg', 90);
    expect(file.text).toBe(`[[field]]\ngap_mm = 9\n${picture}rows = 2\nheading_deg = 90\n\n[model]\nname = "rigid"\n`);
  });

  test('values are found and changed in place', () => {
    const file = new TomlFile(text);
    expect(file.blocks.map((block) => block.name)).toEqual(['', 'row', 'later', 'row']);
    const [first, second] = file.list('row');
    expect(first.get('count')).toBe(3);
    expect(first.get('points_mm')).toEqual([[1, 2], [3, 4]]);
    expect(file.blocks[0].get('title')).toBe('Two # rows');
    first.set('count', 7);
    second.set('count', 8);
    expect(file.text).toBe(text.replace('count = 3 #', 'count = 7 #').replace('count=5', 'count=8'));
  });

  test('new keys follow the last one, new tables the last table', () => {
    const file = new TomlFile(text);
    file.list('row')[1].set('color', '#112233');
    file.blocks[0].set('gravity_m_s2', 9.8);
    file.append('[[brick]]\nat_mm = [0, 0]\n');
    expect(file.text).toContain('count=5\ncolor = "#112233"\n\n[[brick]]\nat_mm = [0, 0]\n');
    expect(file.text).toContain('unknown = {a = 1}\ngravity_m_s2 = 9.8\n');
    const again = new TomlFile(file.text);
    expect(again.list('brick')[0].get('at_mm')).toEqual([0, 0]);
  });

  test('what is removed takes its line, or its block with the comment above it', () => {
    const file = new TomlFile(text);
    file.list('row')[0].remove('points_mm');
    expect(file.text).toContain('count = 3 # three\ntext =');
    file.remove(file.list('row')[0]);
    expect(file.text).not.toContain('# first');
    expect(file.text).toContain('[later]');
  });

  test('an empty file takes a first table', () => {
    const file = new TomlFile('');
    file.append('[[row]]\ncount = 1\n');
    file.needTable('model').set('name', 'hinge');
    expect(file.text).toBe('[[row]]\ncount = 1\n\n[model]\nname = "hinge"\n');
  });

  test('values', () => {
    expect(parseValue('"a\\u00e9"')).toBe('aé');
    expect(parseValue("'raw\\'")).toBe('raw\\');
    expect(parseValue('1_000.5')).toBe(1000.5);
    expect(parseValue('[1, "a, b", [true]]')).toEqual([1, 'a, b', [true]]);
    expect(writeValue([1.00049, 'x', [2]])).toBe('[1, "x", [2]]');
    expect(writeValue(-0.0001)).toBe('0');
  });
});
