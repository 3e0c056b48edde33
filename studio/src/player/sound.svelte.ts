/** Hits are heard while the run plays, at any speed. Off until a person switches it on: browsers want it so, and so do neighbours. */

import { clicksOf, clickSamples, type Click } from './clicks.ts';
import type { Player } from './player.svelte.ts';
import type { Recording } from '../recording/types.ts';

/** More at once would only be noise. */
const kMostAtOnce = 24;

export class Sound {
  on = $state(false);
  /** Clicks that were played, for tests. */
  played = 0;
  private context: AudioContext | null = null;
  private buffer: AudioBuffer | null = null;
  private clicks: Click[] = [];
  private of: Recording | null = null;
  private last = 0;

  constructor(private readonly player: Player) {}

  toggle(): void {
    this.on = !this.on;
    if (!this.on) return this.stop();
    this.context ??= new AudioContext();
    void this.context.resume();
    if (!this.buffer) {
      const samples = clickSamples(this.context.sampleRate);
      this.buffer = this.context.createBuffer(1, samples.length, this.context.sampleRate);
      this.buffer.copyToChannel(samples, 0);
    }
    this.last = this.player.time;
  }

  stop(): void {
    void this.context?.suspend();
  }

  /** Called every frame: plays what happened since the one before. */
  follow(): void {
    const { player, context } = this;
    if (!this.on || !context || !player.recording) return;
    if (this.of !== player.recording) {
      this.of = player.recording;
      this.clicks = clicksOf(player.recording);
    }
    const [from, to] = [this.last, player.time];
    this.last = to;
    if (!player.playing || to <= from || to - from > 1) return;
    if (context.state === 'suspended') void context.resume();
    let i = firstAfter(this.clicks, from);
    for (let n = 0; i < this.clicks.length && this.clicks[i].time <= to && n < kMostAtOnce; i++, n++) {
      this.play(this.clicks[i], (this.clicks[i].time - from) / player.speed);
    }
  }

  private play(click: Click, delay: number): void {
    const context = this.context as AudioContext;
    const source = new AudioBufferSourceNode(context, { buffer: this.buffer, playbackRate: click.pitch });
    const gain = new GainNode(context, { gain: 0.35 * click.loudness });
    source.connect(gain).connect(context.destination);
    source.start(context.currentTime + delay);
    this.played++;
  }
}

function firstAfter(clicks: readonly Click[], time: number): number {
  let [low, high] = [0, clicks.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (clicks[middle].time <= time) low = middle + 1;
    else high = middle;
  }
  return low;
}
