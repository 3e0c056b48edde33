/** Bytes of a `.topple` file (docs/format.md) to a Recording. Damaged or foreign bytes are a FormatError in words; a file cut off after whole pieces gives what it holds. */

import { crc32 } from './crc.ts';
import { FormatError, Payload } from './payload.ts';
import { readEnd, readEnergy, readRecipe, readScene, readShapes, type Scene } from './small_pieces.ts';
import { BrickCollector, EventCollector, TrackCollector } from './collect.ts';
import { EndReason, kNoBrick, type Energy, type Recipe, type Recording, type RunEnd } from './types.ts';

export { FormatError } from './payload.ts';

/** What there is ends before the bricks; more of it may come. */
export class TooShort extends FormatError {
  override name = 'TooShort';
}

const kMagic = 'TOPPLE01';
const kPieceHead = 16;

/** How far decoding has come. */
export interface DecodeProgress {
  bricks: number;
  /** Bricks whose tracks have been read. */
  done: number;
}

/** @param progress Called after each piece. */
export function decodeRecording(bytes: Uint8Array, progress?: (p: DecodeProgress) => void): Recording {
  checkMagic(bytes);
  const read = new Reading();
  let at = kMagic.length;
  while (at < bytes.length && !read.end) {
    const piece = nextPiece(bytes, at);
    if (!piece) break; // cut off inside a piece: what came before is whole
    read.take(piece.payload);
    at = piece.next;
    progress?.({ bricks: read.bricks.expected, done: read.tracks.bricksSeen });
  }
  return read.finish(bytes.length);
}

function checkMagic(bytes: Uint8Array): void {
  if (bytes.length === 0) throw new TooShort('The file is empty.');
  const head = String.fromCharCode(...bytes.subarray(0, kMagic.length));
  if (head === kMagic) return;
  if (/^TOPPLE\d\d$/.test(head)) {
    throw new FormatError(`The file is of version ${Number(head.slice(6))} of the format; this page reads version 1.`);
  }
  throw new FormatError('This is not a recording of Topple: it does not begin with TOPPLE01.');
}

function nextPiece(bytes: Uint8Array, at: number): { payload: Payload; next: number } | null {
  if (bytes.length - at < kPieceHead) return null;
  const view = new DataView(bytes.buffer, bytes.byteOffset + at, kPieceHead);
  const type = String.fromCharCode(...bytes.subarray(at, at + 4));
  if (!/^[\x20-\x7e]{4}$/.test(type)) throw new FormatError(`Damaged at byte ${at}: no piece begins here.`);
  const length = view.getBigUint64(8, true);
  if (length > BigInt(bytes.length - at - kPieceHead)) return null;
  const start = at + kPieceHead;
  const payload = bytes.subarray(start, start + Number(length));
  if (crc32(payload) !== view.getUint32(4, true)) {
    throw new FormatError(`Damaged in the piece ${type} at byte ${at}: its checksum does not agree.`);
  }
  return { payload: new Payload(payload, type, start), next: start + Math.ceil(Number(length) / 8) * 8 };
}

/** What has been read so far, piece by piece. */
class Reading {
  private recipe: Recipe | null = null;
  private scene: Scene | null = null;
  readonly bricks = new BrickCollector();
  readonly tracks = new TrackCollector();
  readonly events = new EventCollector();
  private energy: Energy | null = null;
  end: RunEnd | null = null;

  take(piece: Payload): void {
    switch (piece.type) {
      case 'RCPE':
        this.recipe = readRecipe(piece);
        return;
      case 'SCEN':
        this.scene = readScene(piece);
        return;
      case 'SHAP':
        if (!this.scene) return piece.fail('shapes before the scene');
        return readShapes(piece, this.scene.kinds);
      case 'BRIK':
        if (!this.scene) return piece.fail('bricks before the scene');
        return this.bricks.take(piece, this.scene);
      case 'HING':
        return this.tracks.takeHinged(piece, this.bricks.count);
      case 'FREE':
        return this.tracks.takeFree(piece, this.bricks.count);
      case 'EVNT':
        return this.events.take(piece, this.bricks.count);
      case 'ENRG':
        this.energy = readEnergy(piece);
        return;
      case 'END_':
        this.end = readEnd(piece);
        return;
      default: // a later version's piece, or the hash trail, which the page has no use for
        return;
    }
  }

  finish(size: number): Recording {
    const { recipe, scene } = this;
    if (!recipe || !scene || this.bricks.count === 0) {
      throw new TooShort(`The file was cut off after ${size} bytes, before its bricks. Nothing can be shown.`);
    }
    const bricks = this.bricks.finish();
    const { tracks, hinged, free } = this.tracks.finish(bricks.count);
    const events = this.events.finish();
    let last = this.end?.time ?? 0;
    for (let i = 0; i < tracks.count; i++) last = Math.max(last, tracks.end[i]);
    if (events.count > 0) last = Math.max(last, events.time[events.count - 1]);
    const none = new Float64Array(0);
    const cutOff = { reason: EndReason.cutOff, brick: kNoBrick, steps: 0, time: last, hash: '', words: 'The recording was cut off.' };
    return {
      recipe,
      ...scene,
      bricks,
      tracks,
      hinged,
      free,
      events,
      energy: this.energy ?? { time: none, kinetic: none, potential: none, pushWork: none },
      end: this.end ?? cutOff,
      duration: last,
    };
  }
}
