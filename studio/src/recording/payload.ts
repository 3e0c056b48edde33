/** Reads one payload of a `.topple` file from front to back. Whatever would run over its end is a FormatError that names the byte. */

/** Why a file cannot be read, as a sentence. */
export class FormatError extends Error {
  override name = 'FormatError';
}

const utf8 = new TextDecoder('utf-8', { fatal: true });

export class Payload {
  private at = 0;
  private readonly view: DataView;

  /**
   * @param bytes The payload alone.
   * @param type The piece's four letters, for messages.
   * @param offset Where the payload begins in the file, for messages.
   */
  constructor(
    private readonly bytes: Uint8Array,
    readonly type: string,
    readonly offset: number,
  ) {
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }

  get left(): number {
    return this.bytes.length - this.at;
  }

  fail(what: string): never {
    throw new FormatError(`The piece ${this.type} at byte ${this.offset + this.at}: ${what}.`);
  }

  private need(count: number, what: string): number {
    if (count > this.left) this.fail(`${what} needs ${count} bytes, ${this.left} are left`);
    const start = this.at;
    this.at += count;
    return start;
  }

  u8(what: string): number {
    return this.view.getUint8(this.need(1, what));
  }
  u32(what: string): number {
    return this.view.getUint32(this.need(4, what), true);
  }
  f64(what: string): number {
    return this.view.getFloat64(this.need(8, what), true);
  }
  u64(what: string): bigint {
    return this.view.getBigUint64(this.need(8, what), true);
  }

  /** An f64 that must be finite. */
  finite(what: string): number {
    const value = this.f64(what);
    if (!Number.isFinite(value)) this.fail(`${what} is ${value}, not a finite number`);
    return value;
  }

  string(what: string): string {
    const length = this.u32(`the length of ${what}`);
    const start = this.need(length, what);
    try {
      return utf8.decode(this.bytes.subarray(start, start + length));
    } catch {
      return this.fail(`${what} is not UTF-8`);
    }
  }

  color(what: string): string {
    const rgb = (this.u8(what) << 16) | (this.u8(what) << 8) | this.u8(what);
    return '#' + rgb.toString(16).padStart(6, '0');
  }

  /** How many of something follow; each takes at least `least` bytes, so a count beyond the payload is refused before any room is made. */
  count(what: string, least: number): number {
    const count = this.u32(`the number of ${what}`);
    if (count * least > this.left) this.fail(`${count} ${what} do not fit into the ${this.left} bytes that are left`);
    return count;
  }

  /** Bytes of an array that starts at the next multiple of 8. The answer is aligned, so that it can be viewed as any type. */
  array(bytes: number, what: string): Uint8Array {
    const padding = (8 - (this.at % 8)) % 8;
    this.need(Math.min(padding, this.left), what);
    const start = this.need(bytes, what);
    const part = this.bytes.subarray(start, start + bytes);
    return part.byteOffset % 8 === 0 ? part : part.slice();
  }

  f64s(count: number, what: string): Float64Array {
    const part = this.array(count * 8, what);
    return new Float64Array(part.buffer, part.byteOffset, count);
  }
  f32s(count: number, what: string): Float32Array {
    const part = this.array(count * 4, what);
    return new Float32Array(part.buffer, part.byteOffset, count);
  }
  u32s(count: number, what: string): Uint32Array {
    const part = this.array(count * 4, what);
    return new Uint32Array(part.buffer, part.byteOffset, count);
  }
  u16s(count: number, what: string): Uint16Array {
    const part = this.array(count * 2, what);
    return new Uint16Array(part.buffer, part.byteOffset, count);
  }
  u8s(count: number, what: string): Uint8Array {
    return this.array(count, what);
  }
}
