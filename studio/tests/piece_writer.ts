/** Writes the pieces of docs/format.md, for tests: the page's own encoder, so that tests need no other program. */

import { crc32 } from '../src/recording/crc.ts';

export class PieceWriter {
  private readonly parts: Uint8Array[] = [];
  private size = 0;

  private add(bytes: Uint8Array): this {
    this.parts.push(bytes);
    this.size += bytes.length;
    return this;
  }
  private number(bytes: number, write: (view: DataView) => void): this {
    const view = new DataView(new ArrayBuffer(bytes));
    write(view);
    return this.add(new Uint8Array(view.buffer));
  }
  u8(value: number): this {
    return this.number(1, (view) => view.setUint8(0, value));
  }
  u32(value: number): this {
    return this.number(4, (view) => view.setUint32(0, value, true));
  }
  f64(value: number): this {
    return this.number(8, (view) => view.setFloat64(0, value, true));
  }
  u64(value: bigint): this {
    return this.number(8, (view) => view.setBigUint64(0, value, true));
  }
  string(text: string): this {
    const bytes = new TextEncoder().encode(text);
    return this.u32(bytes.length).add(bytes);
  }
  /** An array, after zero bytes up to a multiple of 8. */
  array(values: ArrayBufferView): this {
    this.add(new Uint8Array((8 - (this.size % 8)) % 8));
    return this.add(new Uint8Array(values.buffer.slice(values.byteOffset, values.byteOffset + values.byteLength) as ArrayBuffer));
  }
  f64s(values: readonly number[]): this {
    return this.array(Float64Array.from(values));
  }
  f32s(values: readonly number[]): this {
    return this.array(Float32Array.from(values));
  }
  u32s(values: readonly number[]): this {
    return this.array(Uint32Array.from(values));
  }
  u16s(values: readonly number[]): this {
    return this.array(Uint16Array.from(values));
  }
  u8s(values: readonly number[]): this {
    return this.array(Uint8Array.from(values));
  }

  /** Head, payload and zero bytes up to a multiple of 8. */
  piece(type: string): Uint8Array {
    const payload = joinBytes(this.parts);
    const padded = Math.ceil(payload.length / 8) * 8;
    const bytes = new Uint8Array(16 + padded);
    const view = new DataView(bytes.buffer);
    for (let i = 0; i < 4; i++) view.setUint8(i, type.charCodeAt(i));
    view.setUint32(4, crc32(payload), true);
    view.setBigUint64(8, BigInt(payload.length), true);
    bytes.set(payload, 16);
    return bytes;
  }
}

export function joinBytes(parts: readonly Uint8Array[]): Uint8Array {
  const all = new Uint8Array(parts.reduce((n, part) => n + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}
