/** The sound of hits: which there are, how loud each is, and the click itself. The same for playing and for a film. */

import { EventKind, type Recording } from '../recording/types.ts';

export interface Click {
  /** [s] of the run. */
  time: number;
  /** 0 to 1. */
  loudness: number;
  /** A brick's own pitch, against the usual one. */
  pitch: number;
}

/** A brick of this height clicks at the usual pitch [m]; larger ones lower. */
const kUsualHeight = 0.048;

/** Every hit, in the order of time: loud by its impulse where the model tells it, else all alike. */
export function clicksOf(recording: Recording): Click[] {
  const { events, kinds, bricks } = recording;
  const hits: number[] = [];
  for (let i = 0; i < events.count; i++) if (events.kind[i] === EventKind.struck || events.kind[i] === EventKind.landed) hits.push(i);
  const known = hits.map((i) => events.impulse[i]).filter((impulse) => Number.isFinite(impulse) && impulse > 0).sort((a, b) => a - b);
  const usual = known[Math.floor(0.9 * (known.length - 1))] ?? NaN;
  return hits.map((i) => {
    const impulse = events.impulse[i];
    const struck = events.kind[i] === EventKind.struck;
    const loudness = Number.isFinite(impulse) && Number.isFinite(usual) ? Math.min(1, Math.sqrt(impulse / usual)) : struck ? 0.7 : 0.25;
    const height = kinds[bricks.kind[events.brick[i]]].height;
    // Each brick is a little different from its neighbours, as real ones are.
    const own = 1 + 0.08 * (((events.brick[i] * 7919) % 17) / 8 - 1);
    return { time: events.time[i], loudness, pitch: Math.min(3, Math.max(0.3, Math.sqrt(kUsualHeight / height))) * own };
  });
}

/** Twenty milliseconds of plastic on plastic: two damped tones and a little noise, the same every time. */
export function clickSamples(rate: number): Float32Array<ArrayBuffer> {
  const samples = new Float32Array(Math.round(0.03 * rate));
  let seed = 1;
  for (let i = 0; i < samples.length; i++) {
    const t = i / rate;
    seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
    const noise = seed / 2147483648 - 1;
    const tones = 0.6 * Math.sin(2 * Math.PI * 2300 * t) * Math.exp(-t / 0.004) + 0.4 * Math.sin(2 * Math.PI * 4100 * t) * Math.exp(-t / 0.0025);
    samples[i] = (tones + 0.5 * noise * Math.exp(-t / 0.0015)) * Math.min(1, t / 0.0002);
  }
  return samples;
}
