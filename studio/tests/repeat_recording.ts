/** A long row out of a short one: the middle brick's track, shifted, for every brick. For measuring, quick to make at any length. */

import { decodeRecording } from '../src/recording/decode.ts';
import { joinBytes, PieceWriter } from './piece_writer.ts';

/** @param step From one brick's hit to the next's [s]. */
export function repeatRecording(short: Uint8Array, count: number, step: number): Uint8Array {
  const model = decodeRecording(short);
  const middle = model.bricks.count >> 1;
  const { tracks, hinged } = model;
  const first = tracks.firstKnot[middle];
  // As many knots as a real track has: each fourth of the first ones.
  const kept = Array.from({ length: 60 }, (_, i) => first + (i < 4 ? i : 4 + (i - 4) * 4)).filter((k) => k < first + tracks.knotCount[middle]);
  const knots = kept.length;
  const scene = new PieceWriter().string('A long row').f64(9.81).f64(0.002).u32(1).string('domino');
  for (const value of [0.048, 0.024, 0.0075, 0.0085, 0.2, 0.5, 0, 0]) scene.f64(value);
  scene.u8(192).u8(57).u8(43).u32(1).u8(192).u8(57).u8(43).u32(1).string('row 1').u32(0).u32(count).u32(0);
  const pieces: Uint8Array[] = [
    new TextEncoder().encode('TOPPLE01'),
    new PieceWriter().string('0.1.0').string('pivot').string('long.toml').string('').f64(0.0005).u32(0).piece('RCPE'),
    scene.piece('SCEN'),
  ];
  const kPiece = 4096;
  for (let from = 0; from < count; from += kPiece) {
    const n = Math.min(kPiece, count - from);
    const zeros = Array.from({ length: n }, () => 0);
    const x = zeros.map((_, i) => (from + i) * 0.024);
    pieces.push(new PieceWriter().u32(from).u32(n).f64s(x).f64s(zeros).f64s(zeros).f64s(zeros).u16s(zeros).u16s(zeros).u8s(zeros).piece('BRIK'));
  }
  for (let from = 0; from < count; from += kPiece) {
    const n = Math.min(kPiece, count - from);
    const each = Array.from({ length: n }, (_, i) => from + i);
    const piece = new PieceWriter().u32(n).u32(n * knots).f64s(each.map((b) => b * step)).u32s(each).u32s(each.map(() => knots));
    for (const column of [hinged.time, hinged.angle, hinged.rate, hinged.acceleration]) {
      const one = Float32Array.from(kept, (k) => column[k]);
      const all = new Float32Array(n * knots);
      for (let i = 0; i < n; i++) all.set(one, i * knots);
      piece.array(all);
    }
    pieces.push(piece.piece('HING'));
  }
  pieces.push(new PieceWriter().u32(1).u32(0xffffffff).u64(1n).f64(count * step + 1).u64(0n).string('All bricks are at rest.').piece('END_'));
  return joinBytes(pieces);
}
