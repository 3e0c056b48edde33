/**
 * A layout file as blocks that can be changed one value at a time. Everything that is not touched stays as it was written: comments, order,
 * spacing, keys and tables that this page does not know. What it says is the engine's business; here only enough of TOML is understood to
 * find keys and values: tables, lists of tables, and values of any sort on one or several lines.
 */

export type TomlValue = number | boolean | string | TomlValue[];

interface Entry {
  key: string;
  /** Where in the block's text the value stands. */
  from: number;
  to: number;
}

/** A header and what belongs to it; the first one, before any header, has an empty name. */
export class Block {
  /** "row"; "contact". */
  readonly name: string;
  readonly isList: boolean;
  private entries: Entry[] | null = null;

  /** @param text With the comments before the header, up to the next block. */
  constructor(private source: string) {
    const header = /^[ \t]*(\[\[?)[ \t]*([^\]\r\n]+?)[ \t]*\]\]?/m.exec(skipComments(source));
    this.name = header ? header[2].replace(/^["']|["']$/g, '') : '';
    this.isList = header?.[1] === '[[';
  }

  get text(): string {
    return this.source;
  }

  keys(): string[] {
    return this.read().map((entry) => entry.key);
  }

  get(key: string): TomlValue | undefined {
    const entry = this.read().find((one) => one.key === key);
    return entry && parseValue(this.source.slice(entry.from, entry.to));
  }
  number(key: string, otherwise: number): number {
    const value = this.get(key);
    return typeof value === 'number' ? value : otherwise;
  }
  string(key: string, otherwise = ''): string {
    const value = this.get(key);
    return typeof value === 'string' ? value : otherwise;
  }
  has(key: string): boolean {
    return this.read().some((entry) => entry.key === key);
  }

  /** Changes a value, or adds it after the last one. */
  set(key: string, value: TomlValue): void {
    const text = writeValue(value);
    const entries = this.read();
    const entry = entries.find((one) => one.key === key);
    if (entry) this.source = this.source.slice(0, entry.from) + text + this.source.slice(entry.to);
    else {
      const last = entries.at(-1);
      const at = last ? endOfLine(this.source, last.to) : this.afterHeader();
      const lead = at > 0 && this.source[at - 1] !== '\n' ? '\n' : '';
      this.source = `${this.source.slice(0, at)}${lead}${key} = ${text}\n${this.source.slice(at)}`;
    }
    this.entries = null;
  }

  remove(key: string): void {
    const entry = this.read().find((one) => one.key === key);
    if (!entry) return;
    const start = this.source.lastIndexOf('\n', entry.from - 1) + 1;
    this.source = this.source.slice(0, start) + this.source.slice(endOfLine(this.source, entry.to));
    this.entries = null;
  }

  private afterHeader(): number {
    if (!this.name) return skipHeadComments(this.source);
    const header = new RegExp(`^[ \\t]*\\[\\[?[^\\n]*`, 'm').exec(skipComments(this.source));
    return header ? endOfLine(this.source, header.index + header[0].length) : this.source.length;
  }

  private read(): Entry[] {
    return (this.entries ??= findEntries(this.source, this.name !== ''));
  }
}

/** Comments blanked out, strings too, so that what looks like a header is one; every character stays in its place. */
function skipComments(text: string): string {
  let out = '';
  for (let at = 0; at < text.length; ) {
    const next = text[at] === '#' ? lineEnd(text, at) : text[at] === '"' || text[at] === "'" ? stringEnd(text, at) : at + 1;
    out += next === at + 1 && text[at] !== '#' ? text[at] : text.slice(at, next).replace(/[^\n]/g, text[at] === '#' ? ' ' : '_');
    at = next;
  }
  return out;
}

/** Comments at the top of a file stay above what is added. */
function skipHeadComments(text: string): number {
  let at = 0;
  while (text[at] === '#') at = endOfLine(text, at);
  return at;
}

function lineEnd(text: string, from: number): number {
  const at = text.indexOf('\n', from);
  return at < 0 ? text.length : at;
}
/** After the line break. */
function endOfLine(text: string, from: number): number {
  return Math.min(text.length, lineEnd(text, from) + 1);
}

function stringEnd(text: string, from: number): number {
  const quote = text[from];
  const triple = text.startsWith(quote.repeat(3), from);
  const close = triple ? quote.repeat(3) : quote;
  for (let at = from + close.length; at < text.length; at++) {
    if (quote === '"' && text[at] === '\\') at++;
    else if (text.startsWith(close, at)) return at + close.length;
    else if (!triple && text[at] === '\n') return at;
  }
  return text.length;
}

/** From the first character of a value to the one after it. */
function valueEnd(text: string, from: number): number {
  let depth = 0;
  let at = from;
  while (at < text.length) {
    const c = text[at];
    if (c === '"' || c === "'") at = stringEnd(text, at);
    else if (c === '#') {
      if (depth === 0) break;
      at = lineEnd(text, at);
    } else if (c === '\n' && depth === 0) break;
    else {
      if (c === '[' || c === '{') depth++;
      if (c === ']' || c === '}') depth--;
      at++;
    }
  }
  while (at > from && /\s/.test(text[at - 1])) at--;
  return at;
}

function findEntries(text: string, hasHeader: boolean): Entry[] {
  const entries: Entry[] = [];
  let headerSeen = !hasHeader;
  for (let at = 0; at < text.length; ) {
    const rest = text.slice(at, lineEnd(text, at));
    if (!headerSeen) {
      headerSeen = /^[ \t]*\[/.test(rest);
      at = endOfLine(text, at);
      continue;
    }
    const found = /^[ \t]*("[^"\n]*"|'[^'\n]*'|[A-Za-z0-9_.-]+)[ \t]*=[ \t]*/.exec(rest);
    if (!found) {
      at = endOfLine(text, at);
      continue;
    }
    const from = at + found[0].length;
    const to = valueEnd(text, from);
    entries.push({ key: found[1].replace(/^["']|["']$/g, ''), from, to });
    at = endOfLine(text, to);
  }
  return entries;
}

/** Numbers, truth, text and lists; anything else as its own text. */
export function parseValue(text: string): TomlValue {
  const bare = text.trim();
  if (bare === 'true' || bare === 'false') return bare === 'true';
  if (bare.startsWith('"') && !bare.startsWith('"""')) {
    try {
      return JSON.parse(bare.replace(/\\U([0-9a-fA-F]{8})/g, (_, code: string) => String.fromCodePoint(parseInt(code, 16)))) as string;
    } catch {
      return bare.slice(1, -1);
    }
  }
  if (bare.startsWith("'") && !bare.startsWith("'''")) return bare.slice(1, -1);
  if (bare.startsWith('[')) return parseList(bare);
  const number = Number(bare.replace(/_/g, '').replace(/^\+/, ''));
  return bare !== '' && Number.isFinite(number) ? number : bare;
}

function parseList(text: string): TomlValue[] {
  const items: TomlValue[] = [];
  let at = 1;
  while (at < text.length - 1) {
    if (/[\s,]/.test(text[at])) at++;
    else if (text[at] === '#') at = lineEnd(text, at);
    else {
      const end = itemEnd(text, at);
      items.push(parseValue(text.slice(at, end)));
      at = end;
    }
  }
  return items;
}

function itemEnd(text: string, from: number): number {
  let depth = 0;
  for (let at = from; at < text.length; ) {
    const c = text[at];
    if (c === '"' || c === "'") {
      at = stringEnd(text, at);
      continue;
    }
    if (c === '[' || c === '{') depth++;
    if (c === ']' || c === '}') depth--;
    if (depth < 0 || (depth === 0 && (c === ',' || c === '#' || c === '\n'))) return at;
    at++;
  }
  return text.length;
}

/** Numbers to a thousandth: of a millimetre or a degree, more would be noise. */
export function writeValue(value: TomlValue): string {
  if (typeof value === 'number') return String(Number(value.toFixed(3)) || 0);
  if (typeof value === 'string') return JSON.stringify(value);
  if (Array.isArray(value)) return `[${value.map(writeValue).join(', ')}]`;
  return String(value);
}

export class TomlFile {
  readonly blocks: Block[];

  constructor(text: string) {
    this.blocks = splitBlocks(text).map((part) => new Block(part));
  }

  get text(): string {
    return this.blocks.map((block) => block.text).join('');
  }

  table(name: string): Block | undefined {
    return this.blocks.find((block) => !block.isList && block.name === name);
  }
  list(name: string): Block[] {
    return this.blocks.filter((block) => block.isList && block.name === name);
  }

  /** A table, made at the end where it is missing. */
  needTable(name: string): Block {
    return this.table(name) ?? this.append(`[${name}]\n`);
  }

  append(text: string): Block {
    const last = this.blocks.at(-1);
    const before = this.text;
    const lead = before === '' || before.endsWith('\n\n') ? '' : before.endsWith('\n') ? '\n' : '\n\n';
    if (last && lead) this.blocks[this.blocks.length - 1] = new Block(last.text + lead);
    const block = new Block(text);
    this.blocks.push(block);
    return block;
  }

  remove(block: Block): void {
    const at = this.blocks.indexOf(block);
    if (at >= 0) this.blocks.splice(at, 1);
  }
}

/** Cut before each header, with the comments that stand right above it. */
function splitBlocks(text: string): string[] {
  const plain = blankValues(text);
  const starts = [0];
  for (const found of plain.matchAll(/^[ \t]*\[/gm)) {
    let at = found.index;
    for (;;) {
      const before = text.lastIndexOf('\n', at - 2) + 1;
      if (at === 0 || !/^[ \t]*#/.test(text.slice(before, at))) break;
      at = before;
    }
    if (at > 0) starts.push(at);
  }
  return starts.map((start, i) => text.slice(start, starts[i + 1] ?? text.length));
}

/** The same text with comments, strings and everything inside brackets of values blanked out, so that headers can be told. */
function blankValues(text: string): string {
  const plain = skipComments(text);
  let out = '';
  for (let at = 0; at < plain.length; ) {
    const end = lineEnd(plain, at);
    const line = plain.slice(at, end);
    const equals = line.indexOf('=');
    if (equals < 0 || /^[ \t]*\[/.test(line)) {
      out += plain.slice(at, Math.min(plain.length, end + 1));
      at = end + 1;
      continue;
    }
    const from = at + equals + 1;
    const to = Math.max(end, valueEnd(plain, from));
    out += plain.slice(at, from) + plain.slice(from, to).replace(/[^\n]/g, ' ');
    at = to;
  }
  return out;
}
