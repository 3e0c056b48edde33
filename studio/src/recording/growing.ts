/** A recording that comes in pieces while its run goes on: what can be played of it so far. */

import { decodeRecording, TooShort } from './decode.ts';
import { joinBytes } from './join_bytes.ts';
import { EventKind, type Recording } from './types.ts';

/** A new look is worth its cost when so much more has come than was there at the last one. */
const kGrowth = 1.25;

export class GrowingRecording {
  private pieces: Uint8Array<ArrayBuffer>[] = [];
  private size = 0;
  private seen = 0;
  /** Up to when it could be played at the last look [s]. */
  reached = 0;

  add(bytes: Uint8Array<ArrayBuffer>): void {
    this.pieces.push(bytes);
    this.size += bytes.length;
  }

  /** Whether enough has come since the last look, or a look is cheap. */
  get worthALook(): boolean {
    return this.size > this.seen && this.size > Math.min(kGrowth * this.seen, this.seen + 16e6);
  }

  /** All that has come, as one recording; while it goes on it ends where every motion is known. */
  look(over: boolean): Recording {
    const all = joinBytes(this.pieces);
    this.pieces = [all];
    this.seen = this.size;
    const recording = decodeRecording(all);
    if (!over) recording.duration = settledTime(recording);
    this.reached = recording.duration;
    return recording;
  }

  /** The same; null where not even its bricks have come. */
  glance(over: boolean): Recording | null {
    try {
      return this.look(over);
    } catch (error) {
      if (error instanceof TooShort) return null;
      throw error;
    }
  }

  /** The bytes of the recording so far: a `.topple` file. */
  bytes(): Uint8Array<ArrayBuffer> {
    return joinBytes(this.pieces);
  }
}

/** Until when every brick's motion has come [s]: one that was struck and does not rest yet is known up to the end of its last track. */
export function settledTime(recording: Recording): number {
  const { events, tracks, bricks } = recording;
  const open = new Float64Array(bricks.count).fill(NaN);
  for (let i = 0; i < events.count; i++) {
    const brick = events.brick[i];
    if (events.kind[i] === EventKind.rested) open[brick] = NaN;
    else if ((events.kind[i] === EventKind.struck || events.kind[i] === EventKind.pushed) && Number.isNaN(open[brick])) open[brick] = events.time[i];
  }
  let settled = recording.duration;
  for (let brick = 0; brick < bricks.count; brick++) {
    if (Number.isNaN(open[brick])) continue;
    const last = tracks.firstOf[brick + 1] - 1;
    const known = last >= tracks.firstOf[brick] ? Math.max(open[brick], tracks.end[last]) : open[brick];
    settled = Math.min(settled, known);
  }
  return Math.max(0, settled);
}
