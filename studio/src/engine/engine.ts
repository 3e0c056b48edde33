/**
 * The engine, which is the same C++ as the program `topple`, as a typed object around its WebAssembly module. It knows nothing of workers,
 * browsers or files: bytes of the module in, text and bytes out, so that node can use it as well.
 */

/** How many bricks of a kind or colour. */
export interface Count {
  name: string;
  bricks: number;
}

/** What geometry says against a layout; the words are for people. */
export interface Doubt {
  kind: 'overlap' | 'miss' | 'beyond_reach' | 'no_neighbour' | 'no_push';
  brick: number;
  /** -1: none. */
  other: number;
  /** [m] */
  amount: number;
  words: string;
}

/** A layout as the engine understood it. */
export interface Draft {
  bricks: number;
  /** Along all parts, foot to foot [m]. */
  length: number;
  kinds: Count[];
  colors: Count[];
  doubts: Doubt[];
  /** The beginning of a recording: its scene and its bricks (docs/format.md). */
  scene: Uint8Array<ArrayBuffer>;
}

/** What a picture is made of. */
export interface PictureOrder {
  /** Red, green, blue and opacity of each pixel, line by line from the upper left. */
  pixels: Uint8ClampedArray<ArrayBuffer>;
  width: number;
  height: number;
  /** Brick to brick in a row, and from row to row [m]. */
  pitch: number;
  rowPitch: number;
  /** About how many in all. */
  bricks: number;
  dither: boolean;
  /** "#rrggbb", and how many bricks there are of it; none at all: the usual colours. */
  colors: { color: string; stock?: number }[];
}

/** A picture in bricks. */
export interface Picture {
  rows: number;
  count: number;
  /** Bricks by colour. */
  used: number[];
  /** `palette` and `picture` of a field in a layout file. */
  text: string;
  /** Which colour, line by line as it is seen from above. */
  cells: Uint8Array<ArrayBuffer>;
}

/** Some of all, and the ends of the 95 % interval of the share behind it. */
export interface Share {
  count: number;
  of: number;
  low: number;
  high: number;
}

/** What many runs came to whose bricks were put down by hand (docs/risk.md). */
export interface Risk {
  runs: number;
  /** Runs that do not count, since two bricks would have been in one place. */
  notBuilt: number;
  /** In which all fell that fall when every brick is exactly in its place. */
  whole: Share;
  /** When the wave reached its last brick, mean and standard deviation of the whole runs [s]; null without any. */
  arrival: number | null;
  spread: number | null;
  /** Bricks that are struck by another one, or pushed. */
  links: number;
  /** Of those that never stopped, the one that the fewest runs came to. */
  held: Share;
  /** Bricks that stand even when all are exactly in their places. */
  exactlyStanding: number;
  /** Links that stopped, the weakest first. */
  weak: { brick: number; stops: Share }[];
  /** Parts with links, the weakest first. */
  parts: { name: string; stops: Share }[];
}

/** Why a layout cannot be read or run: every problem, "name:line:column: key: what is wrong". */
export class LayoutError extends Error {
  override name = 'LayoutError';
  get problems(): string[] {
    return this.message.split('\n');
  }
}

/** What the module exports; sizes and addresses in bytes. */
interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  topple_reserve(size: number): number;
  topple_release(room: number): void;
  topple_bytes(): number;
  topple_byte_count(): number;
  topple_answer(): number;
  topple_answer_size(): number;
  topple_read(...texts: number[]): number;
  topple_start(...texts: number[]): number;
  topple_advance(steps: number): number;
  topple_stop(): void;
  topple_collect(over: number): void;
  topple_watch(...texts: number[]): number;
  topple_watch_steps(steps: number): number;
  topple_picture(pixels: number, width: number, height: number, asked: number, numbers: number): number;
  topple_risk_begin(...textsAndErrors: number[]): number;
  topple_risk_run(seed: number): number;
  topple_risk_add(numbers: number, count: number): void;
  topple_risk_answer(): void;
  topple_time(): number;
  topple_arrived(): number;
  topple_steps(): number;
  topple_hash(): void;
}

/** A C library on WASI asks for these; the engine opens and prints nothing, so that each may refuse. */
function wasi(): WebAssembly.ModuleImports {
  const kNoSuchFile = 8;
  const none = (): number => kNoSuchFile;
  return {
    environ_get: () => 0,
    environ_sizes_get: () => 0,
    proc_exit: (code: number) => {
      throw new Error(`the engine ended with ${code}`);
    },
    fd_close: none,
    fd_seek: none,
    fd_write: none,
    fd_read: none,
    fd_fdstat_get: none,
    fd_prestat_get: none,
    fd_prestat_dir_name: none,
    clock_time_get: none,
    random_get: none,
  };
}

const encoder = new TextEncoder();
const decoder = new TextDecoder();

export class Engine {
  private constructor(private readonly c: Exports) {}

  static async load(module: BufferSource | WebAssembly.Module | Response | Promise<Response>): Promise<Engine> {
    const imports = { wasi_snapshot_preview1: wasi() };
    let instance: WebAssembly.Instance;
    if (module instanceof WebAssembly.Module) instance = await WebAssembly.instantiate(module, imports);
    else if (module instanceof ArrayBuffer || ArrayBuffer.isView(module)) {
      instance = (await WebAssembly.instantiate(module, imports)).instance;
    } else instance = (await WebAssembly.instantiateStreaming(module as Response | Promise<Response>, imports)).instance;
    const c = instance.exports as unknown as Exports;
    c._initialize();
    return new Engine(c);
  }

  /** Memory that the engine holds [bytes]. */
  get memory(): number {
    return this.c.memory.buffer.byteLength;
  }

  /** @param overrides `key=value`, as `--set` of the program takes them. @throws LayoutError */
  read(text: string, name = 'layout.toml', overrides: readonly string[] = []): Draft {
    if (!this.withTexts(this.c.topple_read, [text, name, overrides.join('\n')])) throw new LayoutError(this.answer());
    const draft = JSON.parse(this.answer()) as Omit<Draft, 'scene'>;
    return { ...draft, scene: this.bytes() };
  }

  /** Begins a run. @returns The first bytes of its recording. @throws LayoutError */
  start(text: string, name = 'layout.toml', overrides: readonly string[] = []): Uint8Array<ArrayBuffer> {
    if (!this.withTexts(this.c.topple_start, [text, name, overrides.join('\n')])) throw new LayoutError(this.answer());
    return this.bytes();
  }

  /** Runs on by so many steps. @returns Whether the run goes on. */
  advance(steps: number): boolean {
    return this.c.topple_advance(steps) !== 0;
  }

  stop(): void {
    this.c.topple_stop();
  }

  /** What was recorded since the last call: whole pieces; with `over` the rest and the end. */
  collect(over: boolean): Uint8Array<ArrayBuffer> {
    this.c.topple_collect(over ? 1 : 0);
    return this.bytes();
  }

  /** Begins to watch the forces at contacts of a run, of which nothing is recorded. @throws LayoutError */
  watch(text: string, name = 'layout.toml', overrides: readonly string[] = []): void {
    if (!this.withTexts(this.c.topple_watch, [text, name, overrides.join('\n')])) throw new LayoutError(this.answer());
  }

  /** So many steps of it. @returns Their contacts as forces.ts reads them, and whether it goes on. */
  watchSteps(steps: number): { bytes: Uint8Array<ArrayBuffer>; more: boolean } {
    const more = this.c.topple_watch_steps(steps) !== 0;
    return { bytes: this.bytes(), more };
  }

  /** An image as bricks. @throws LayoutError where there are too few bricks, or too many. */
  picture({ pixels, width, height, pitch, rowPitch, bricks, dither, colors }: PictureOrder): Picture {
    const asked = [pitch, rowPitch, bricks, dither ? 1 : 0, ...colors.flatMap(({ color, stock }) => [parseInt(color.slice(1), 16), stock ?? -1])];
    const room = this.c.topple_reserve(pixels.length + 8 * asked.length);
    new Float64Array(this.c.memory.buffer, room, asked.length).set(asked);
    new Uint8Array(this.c.memory.buffer, room + 8 * asked.length, pixels.length).set(pixels);
    const good = this.c.topple_picture(room + 8 * asked.length, width, height, room, asked.length) !== 0;
    this.c.topple_release(room);
    if (!good) throw new LayoutError(this.answer());
    return { ...(JSON.parse(this.answer()) as Omit<Picture, 'cells'>), cells: this.bytes() };
  }

  /**
   * Begins to ask how likely a run stops whose bricks are put down by hand: runs it with every brick exactly in its place.
   * @param position Standard deviation along x, and along y [m]. @param heading The same of the heading [rad]. @throws LayoutError
   */
  riskBegin(text: string, name: string, overrides: readonly string[], position: number, heading: number): void {
    const begin = (...texts: number[]): number => this.c.topple_risk_begin(...texts, position, heading);
    if (!this.withTexts(begin, [text, name, overrides.join('\n')])) throw new LayoutError(this.answer());
  }

  /** The run of one seed, which is not added. @returns It, in numbers. @throws LayoutError */
  riskRun(seed: number): Float64Array<ArrayBuffer> {
    if (!this.c.topple_risk_run(seed)) throw new LayoutError(this.answer());
    return new Float64Array(this.bytes().buffer);
  }

  /** Adds a run, of this engine or another one of the same study. */
  riskAdd(run: Float64Array): void {
    const room = this.c.topple_reserve(run.byteLength);
    new Float64Array(this.c.memory.buffer, room, run.length).set(run);
    this.c.topple_risk_add(room, run.length);
    this.c.topple_release(room);
  }

  /** What all runs that were added came to. */
  risk(): Risk {
    this.c.topple_risk_answer();
    return JSON.parse(this.answer()) as Risk;
  }

  /** Simulated so far [s]. */
  get time(): number {
    return this.c.topple_time();
  }
  /** Bricks that the wave has reached. */
  get arrived(): number {
    return this.c.topple_arrived();
  }
  get steps(): number {
    return this.c.topple_steps();
  }
  /** Of a run that is over: 16 hexadecimal digits. */
  get hash(): string {
    this.c.topple_hash();
    return this.answer();
  }

  private answer(): string {
    return decoder.decode(new Uint8Array(this.c.memory.buffer, this.c.topple_answer(), this.c.topple_answer_size()));
  }

  /** Out of the engine's memory, which may move: the one copy there is; from here on they are handed over. */
  private bytes(): Uint8Array<ArrayBuffer> {
    return new Uint8Array(this.c.memory.buffer, this.c.topple_bytes(), this.c.topple_byte_count()).slice() as Uint8Array<ArrayBuffer>;
  }

  private withTexts(call: (...texts: number[]) => number, texts: string[]): boolean {
    const places: number[] = [];
    const rooms: number[] = [];
    for (const text of texts) {
      const bytes = encoder.encode(text);
      const room = this.c.topple_reserve(bytes.length + 1);
      new Uint8Array(this.c.memory.buffer, room, bytes.length).set(bytes);
      rooms.push(room);
      places.push(room, bytes.length);
    }
    const good = call(...places) !== 0;
    for (const room of rooms) this.c.topple_release(room);
    return good;
  }
}
