import { EndReason, kNoBrick, type Recording } from './types.ts';

/** A table without bricks. */
export function emptyRecording(): Recording {
  const none = new Float64Array(0);
  const few = new Float32Array(0);
  const whole = new Uint32Array(0);
  const small = new Uint8Array(0);
  return {
    recipe: { version: '', model: '', layoutName: '', layoutText: '', timeStep: 0, overrides: [] },
    title: '', gravity: 9.81, kinds: [], colors: [], parts: [], pushes: [],
    bricks: { count: 0, foot: none, heading: none, kind: new Uint16Array(0), color: new Uint16Array(0), stance: small },
    tracks: { count: 0, firstOf: new Uint32Array(1), brick: whole, start: none, end: none, free: small, firstKnot: whole, knotCount: whole },
    hinged: { time: few, angle: few, rate: few, acceleration: few },
    free: { time: few, state: few },
    events: { count: 0, time: none, brick: whole, by: whole, kind: small, force: few, impulse: few, where: few },
    energy: { time: none, kinetic: none, potential: none, pushWork: none },
    end: { reason: EndReason.cutOff, brick: kNoBrick, steps: 0, time: 0, hash: '', words: '' },
    duration: 0,
  };
}
