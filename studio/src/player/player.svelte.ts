/** What is played and how: the state that every panel shares. Knows nothing of the page's elements or of WebGL. */

import type { Loaded, LoadProgress } from '../recording/load.ts';
import { EventIndex } from '../recording/story.ts';
import { EventKind, type Events, type Recording } from '../recording/types.ts';
import { lastNotOver, type Front } from '../recording/wave.ts';
import { firstSpeed, nextStop } from './speeds.ts';

/** A frame step is what a screen of 60 pictures a second would show next at the chosen speed. */
const kFrame = 1 / 60;
/** Slow motion: how slow, and how much before and after the cursor [s of the run]. */
const kSlow = 1 / 10;
const kSlowBefore = 0.1;
const kSlowAfter = 0.2;

/** Numbers that `topple run --json` prints, as far as the page shows them. */
export interface Summary {
  front_speed_m_s: number | null;
  end: string;
}

export class Player {
  loaded = $state.raw<Loaded | null>(null);
  index = $state.raw<EventIndex | null>(null);
  summary = $state.raw<Summary | null>(null);
  progress = $state.raw<LoadProgress | null>(null);
  failure = $state('');
  /** [s] */
  time = $state(0);
  playing = $state(false);
  speed = $state(1);
  looping = $state(false);
  /** The part that is looped [s]; null: all. */
  range = $state.raw<{ from: number; to: number } | null>(null);
  /** The chosen brick, -1: none. */
  chosen = $state(-1);

  get recording(): Recording | null {
    return this.loaded?.recording ?? null;
  }
  get front(): Front | null {
    return this.loaded?.front ?? null;
  }
  get duration(): number {
    return this.loaded?.recording.duration ?? 0;
  }

  open(loaded: Loaded): void {
    this.loaded = loaded;
    this.index = new EventIndex(loaded.recording);
    this.progress = null;
    this.failure = '';
    this.time = 0;
    this.playing = false;
    this.growing = false;
    this.chosen = -1;
    this.range = null;
    this.slowed = null;
    this.speed = firstSpeed(loaded.recording.duration);
  }

  /** Whether more of the run is still to come. */
  growing = $state(false);
  /** How long the run is expected to be [s]; NaN: not known. */
  expected = $state(NaN);

  /** The bricks of a layout, without any motion. */
  show(recording: Recording): void {
    const none = { time: new Float64Array(0), brick: new Uint32Array(0), distance: new Float64Array(0), length: 0 };
    this.loaded = { recording, front: none, falls: new Float64Array(0) };
    this.index = new EventIndex(recording);
    this.time = 0;
    this.playing = false;
    this.growing = false;
    this.chosen = -1;
    this.range = null;
    this.slowed = null;
  }

  /** More of the run that is shown. */
  grow(loaded: Loaded, over: boolean): void {
    this.loaded = loaded;
    this.index = new EventIndex(loaded.recording);
    this.growing = !over;
    this.time = Math.min(this.time, loaded.recording.duration);
  }

  toggle(): void {
    if (this.playing) this.playing = false;
    else this.play();
  }

  play(): void {
    if (!this.loaded) return;
    const end = this.range?.to ?? this.duration;
    if (this.time >= end - 1e-9) this.time = this.range?.from ?? 0;
    this.playing = true;
  }

  seek(time: number): void {
    this.time = Math.min(this.duration, Math.max(0, time));
  }

  /** Moves on by `dt` of a person's seconds. */
  advance(dt: number): void {
    if (!this.playing) return;
    const from = this.looping ? (this.range?.from ?? 0) : 0;
    const to = this.looping ? (this.range?.to ?? this.duration) : this.duration;
    let time = this.time + dt * this.speed;
    if (time >= to) {
      if (this.looping && to > from) time = from + ((time - to) % (to - from));
      else {
        time = to;
        if (!this.growing) this.playing = false; // else it waits for more
      }
    }
    this.time = time;
  }

  /** What slow motion around the cursor takes the place of; null: it is off. */
  slowed = $state.raw<{ speed: number; looping: boolean; range: { from: number; to: number } | null } | null>(null);

  /** Slow motion around the cursor, over and over; again: on as before. */
  toggleSlow(): void {
    if (this.slowed) {
      Object.assign(this, { ...this.slowed, slowed: null });
      return;
    }
    if (!this.loaded) return;
    const { speed, looping, range, time } = this;
    this.slowed = { speed, looping, range };
    const from = Math.max(0, Math.min(time, this.duration - kSlowAfter) - kSlowBefore);
    this.range = { from, to: Math.min(this.duration, from + kSlowBefore + kSlowAfter) };
    this.looping = true;
    this.speed = kSlow;
    this.time = from;
    this.playing = true;
  }

  /** @param frames How many, backwards if negative. */
  step(frames: number): void {
    this.playing = false;
    this.seek(this.time + frames * kFrame * this.speed);
  }

  changeSpeed(way: 1 | -1): void {
    this.speed = nextStop(this.speed, way);
  }

  choose(brick: number): void {
    const count = this.recording?.bricks.count ?? 0;
    this.chosen = brick >= 0 && brick < count ? brick : -1;
  }

  chooseNext(way: 1 | -1): void {
    const count = this.recording?.bricks.count ?? 0;
    if (count === 0) return;
    if (this.chosen < 0) this.choose(this.frontBrick());
    else this.choose((this.chosen + way + count) % count);
  }

  /** The brick that the wave reached last, or the first that is pushed. */
  frontBrick(): number {
    const { front, recording } = this;
    const i = front ? lastNotOver(front.time, this.time) : -1;
    return front && i >= 0 ? front.brick[i] : (recording?.pushes[0]?.brick ?? 0);
  }

  /** To the event before or after: of the chosen brick, or any push, hit or landing of the run. */
  seekEvent(way: 1 | -1): void {
    const times = this.eventTimes();
    const beyond = way > 0 ? times.filter((t) => t > this.time + 1e-9) : times.filter((t) => t < this.time - 1e-9);
    const time = way > 0 ? beyond[0] : beyond.at(-1);
    this.playing = false;
    if (time !== undefined) this.seek(time);
  }

  private eventTimes(): number[] {
    const { recording, index, chosen } = this;
    if (!recording || !index) return [];
    const { events } = recording;
    if (chosen >= 0) return Array.from(index.of(chosen), (i) => events.time[i]);
    return timesOf(events, (kind) => kind === EventKind.pushed || kind === EventKind.struck || kind === EventKind.landed);
  }
}

function timesOf(events: Events, wanted: (kind: EventKind) => boolean): number[] {
  const times: number[] = [];
  for (let i = 0; i < events.count; i++) if (wanted(events.kind[i])) times.push(events.time[i]);
  return times;
}
