import { describe, expect, test } from 'vitest';
import { crc32 } from '../../src/recording/crc.ts';
import { decodeRecording, FormatError } from '../../src/recording/decode.ts';
import { GrowingRecording } from '../../src/recording/growing.ts';
import { EndReason } from '../../src/recording/types.ts';
import { makeRecording } from '../make_recording.ts';
import { joinBytes, PieceWriter } from '../piece_writer.ts';

const whole = makeRecording({ count: 12 });

/** Where each piece begins, with its type and length. */
function piecesOf(bytes: Uint8Array): { at: number; type: string; length: number }[] {
  const out = [];
  for (let at = 8; at < bytes.length; ) {
    const view = new DataView(bytes.buffer, at);
    const length = Number(view.getBigUint64(8, true));
    out.push({ at, type: String.fromCharCode(...bytes.subarray(at, at + 4)), length });
    at += 16 + Math.ceil(length / 8) * 8;
  }
  return out;
}

/** The same file with one piece's payload changed and its checksum made right again. */
function withPayload(type: string, change: (view: DataView) => void): Uint8Array {
  const bytes = whole.slice();
  const piece = piecesOf(bytes).find((p) => p.type === type);
  if (!piece) throw new Error(type);
  change(new DataView(bytes.buffer, piece.at + 16, piece.length));
  new DataView(bytes.buffer).setUint32(piece.at + 4, crc32(bytes.subarray(piece.at + 16, piece.at + 16 + piece.length)), true);
  return bytes;
}

describe('decoding', () => {
  test('the checksum is the one of zlib: "123456789" gives CBF43926', () => {
    expect(crc32(new TextEncoder().encode('123456789'))).toBe(0xcbf43926);
  });

  test('a whole file gives back what was written', () => {
    const r = decodeRecording(whole);
    expect(r.title).toBe('A row');
    expect(r.recipe).toMatchObject({ version: '0.1.0', model: 'pivot', timeStep: 0.0005 });
    expect(r.bricks.count).toBe(12);
    expect(r.bricks.foot[3 * 5]).toBeCloseTo(5 * 0.024, 12);
    expect(r.kinds[0]).toMatchObject({ name: 'domino', height: 0.048, width: 0.024, thickness: 0.0075, mass: 0.0085, color: '#c0392b' });
    expect(r.tracks.count).toBe(12);
    expect(Array.from(r.tracks.firstOf)).toEqual(Array.from({ length: 13 }, (_, i) => i));
    expect(r.end).toMatchObject({ reason: EndReason.atRest, hash: '000000007f3a91c2', words: 'All bricks are at rest.' });
  });

  test('several pieces of tracks, out of order, end up by brick and start', () => {
    const track = (brick: number, start: number, angle: number): Uint8Array =>
      new PieceWriter().u32(1).u32(1).f64s([start]).u32s([brick]).u32s([1]).f32s([0]).f32s([angle]).f32s([0]).f32s([0]).piece('HING');
    const pieces = piecesOf(whole);
    const cut = pieces.find((p) => p.type === 'HING')!.at;
    const r = decodeRecording(joinBytes([whole.subarray(0, cut), track(3, 2, 0.2), track(1, 0, 0.5), track(3, 1, 0.1), track(3, 3, 0.3)]));
    expect(Array.from(r.tracks.brick)).toEqual([1, 3, 3, 3]);
    expect(Array.from(r.tracks.start)).toEqual([0, 1, 2, 3]);
    expect(Array.from(r.tracks.firstKnot, (k) => Math.fround(r.hinged.angle[k]))).toEqual([0.5, 0.1, 0.2, 0.3].map(Math.fround));
  });

  test('tracks that share the knots of another are played from them, in whatever piece', () => {
    const piece = (start: number, angle: number): Uint8Array =>
      new PieceWriter().u32(3).u32(2).f64s([start, start + 1, start + 2]).u32s([2, 4, 5]).u32s([2, 0x80000000, 0x80000000])
        .f32s([0, 0.5]).f32s([0, angle]).f32s([0, 0]).f32s([0, 0]).piece('HING');
    const cut = piecesOf(whole).find((p) => p.type === 'HING')!.at;
    const bytes = joinBytes([whole.subarray(0, cut), piece(1, 0.25), piece(10, 0.75)]);
    for (const r of [decodeRecording(bytes), decodeRecording(bytes)]) {
      expect(Array.from(r.tracks.brick)).toEqual([2, 2, 4, 4, 5, 5]);
      expect(Array.from(r.tracks.end)).toEqual([1.5, 10.5, 2.5, 11.5, 3.5, 12.5]);
      expect(Array.from(r.tracks.firstKnot)).toEqual([0, 2, 0, 2, 0, 2]);
      expect(Array.from(r.tracks.knotCount)).toEqual([2, 2, 2, 2, 2, 2]);
      expect(r.hinged.angle.length).toBe(4);
    }
  });

  test.each([2, 3, 0x7fffffff])('a track with the knots of track %i, which is none before it, is refused', (owner) => {
    const track = new PieceWriter().u32(3).u32(1).f64s([0, 1, 2]).u32s([2, 4, 5]).u32s([1, 0x80000000, 0x80000000 + owner])
      .f32s([0]).f32s([0]).f32s([0]).f32s([0]).piece('HING');
    const cut = piecesOf(whole).find((p) => p.type === 'HING')!.at;
    expect(() => decodeRecording(joinBytes([whole.subarray(0, cut), track]))).toThrow(/brick 5 has the knots of none before it/);
  });

  test('a file cut off at any byte gives what is whole or says in words why not', () => {
    for (let size = 0; size < whole.length; size += 7) {
      try {
        const r = decodeRecording(whole.slice(0, size));
        expect(r.bricks.count).toBe(12);
        expect(r.end.reason).toBe(EndReason.cutOff);
      } catch (error) {
        expect(error).toBeInstanceOf(FormatError);
      }
    }
  });

  test('a recording that comes in pieces can be looked at once its bricks have come, and not before', () => {
    const bricks = piecesOf(whole).find((p) => p.type === 'BRIK')!;
    const growing = new GrowingRecording();
    expect(growing.glance(false)).toBeNull();
    growing.add(whole.slice(0, bricks.at + 40));
    expect(growing.glance(false)).toBeNull();
    growing.add(whole.slice(bricks.at + 40));
    expect(growing.glance(true)?.bricks.count).toBe(12);
    const damaged = new GrowingRecording();
    damaged.add(new TextEncoder().encode('something else entirely'));
    expect(() => damaged.glance(false)).toThrow(/not a recording/);
  });

  test('a bit flipped in any payload is refused by its checksum, with the piece and the byte', () => {
    for (const { at, type, length } of piecesOf(whole)) {
      const bytes = whole.slice();
      bytes[at + 16 + (length >> 1)] ^= 4;
      expect(() => decodeRecording(bytes)).toThrow(`Damaged in the piece ${type} at byte ${at}`);
    }
  });

  test('one flipped bit anywhere is noticed, or harmless: never another error, never other bricks', () => {
    for (let at = 0; at < whole.length; at += 11) {
      const bytes = whole.slice();
      bytes[at] ^= 1 << (at % 8);
      try {
        expect(decodeRecording(bytes).bricks.count).toBe(12);
      } catch (error) {
        expect(error).toBeInstanceOf(FormatError);
      }
    }
  });

  test.each([
    ['an empty file', new Uint8Array(0), /empty/],
    ['a foreign file', new TextEncoder().encode('PNG and something else'), /not a recording of Topple/],
    ['a later version', new TextEncoder().encode('TOPPLE02........'), /version 2/],
  ])('%s is refused in words', (_, bytes, words) => {
    expect(() => decodeRecording(bytes)).toThrow(words);
  });

  test.each([
    ['a count that does not fit', 'BRIK', (v: DataView) => v.setUint32(4, 0xffffffff, true), /do not fit/],
    ['a track of a brick that is not there', 'HING', (v: DataView) => v.setUint32(8 + 12 * 8, 99, true), /brick 99, but there are 12/],
    ['knots that are not told right', 'HING', (v: DataView) => v.setUint32(8 + 12 * 8 + 48, 1, true), /knots, the piece says/],
    ['a place that is not finite', 'BRIK', (v: DataView) => v.setFloat64(8, NaN, true), /no finite place/],
    ['an event of a brick that is not there', 'EVNT', (v: DataView) => v.setUint32(4 + v.getUint32(0, true) * 8 + 4, 77, true), /brick 77/],
  ])('%s is refused although the checksum agrees', (_, type, change, words) => {
    expect(() => decodeRecording(withPayload(type, change))).toThrow(words);
  });

  test('an unknown piece is skipped', () => {
    const strange = new PieceWriter().string('from a later version').piece('XTRA');
    expect(decodeRecording(joinBytes([whole.subarray(0, 8), strange, whole.subarray(8)])).bricks.count).toBe(12);
  });
});
