/** A film, frame by frame and not captured from the screen: each picture is drawn for its own moment, however long that takes. */

import { AudioBufferSource, BufferTarget, CanvasSource, Mp4OutputFormat, Output, WebMOutputFormat, getFirstEncodableAudioCodec, getFirstEncodableVideoCodec } from 'mediabunny';
import { clicksOf, clickSamples } from '../player/clicks.ts';
import { ArrowLayer } from './arrow_layer.ts';
import type { Player } from '../player/player.svelte.ts';
import type { Stage } from '../player/stage.svelte.ts';
import type { Recording } from '../recording/types.ts';
import { usualEnd } from '../recording/wave.ts';

export type FilmCamera = 'still' | 'orbit' | 'front' | 'eye' | 'top';

export interface FilmOrder {
  format: 'mp4' | 'webm';
  camera: FilmCamera;
  /** [px], even. */
  width: number;
  height: number;
  fps: number;
  /** Seconds of the run in a second of the film. */
  speed: number;
  /** [s] of the run; `to` not a number: a second after the last hit that matters. */
  from: number;
  to: number;
  sound: boolean;
  /** Whether the forces at contacts are shown, of the chosen brick or of all. */
  forces?: boolean;
  /** Pictures averaged into a frame: 1 is plain, more give soft shadows and depth of field. */
  samples: number;
}

export interface FilmWatch {
  progress: (done: number, of: number) => void;
  cancelled: () => boolean;
}

export class FilmCancelled extends Error {
  override name = 'FilmCancelled';
}

/** How far the orbit turns in a second of film [rad]. */
const kOrbitRate = 0.12;

export async function makeFilm(player: Player, stage: Stage, order: FilmOrder, watch: FilmWatch): Promise<Uint8Array<ArrayBuffer>> {
  const { recording } = player;
  const view = stage.view;
  if (!recording || !view) throw new Error('There is nothing to film: no run is open, or there is no 3-D view.');
  const [width, height] = [2 * Math.round(order.width / 2), 2 * Math.round(order.height / 2)];
  const to = Number.isFinite(order.to) ? Math.min(order.to, recording.duration) : usualEnd(recording);
  const frames = Math.max(1, Math.round(((to - order.from) / order.speed) * order.fps));
  const videoCodec = await getFirstEncodableVideoCodec(order.format === 'mp4' ? ['avc', 'av1', 'vp9'] : ['vp9', 'vp8', 'av1'], { width, height });
  if (!videoCodec) throw new Error(`This browser cannot write ${order.format === 'mp4' ? 'MP4' : 'WebM'} films of ${width} × ${height} pixels. Try the other format, or a smaller size.`);
  const target = new BufferTarget();
  const output = new Output({ format: order.format === 'mp4' ? new Mp4OutputFormat() : new WebMOutputFormat(), target });
  const arrows = order.forces ? new ArrowLayer(player, view, width, height) : null;
  const video = new CanvasSource(arrows?.sheet ?? view.canvas, { codec: videoCodec, bitrate: Math.max(2e6, 0.1 * width * height * order.fps), keyFrameInterval: 2 });
  output.addVideoTrack(video, { frameRate: order.fps });
  const audio = order.sound ? await soundTrack(output, order) : null;
  await output.start();
  const before = { time: player.time, way: stage.way, playing: player.playing, stills: view.stills };
  player.playing = false;
  stage.filming = true;
  view.stills = false;
  try {
    view.resize(width, height, 1);
    if (order.camera !== 'still' && order.camera !== 'orbit') cutTo(stage, order.camera);
    if (audio) await audio.add(await soundOf(recording, order, to));
    for (let frame = 0; frame < frames; frame++) {
      if (watch.cancelled()) throw new FilmCancelled('The film was cancelled.');
      player.time = Math.min(to, order.from + (frame / order.fps) * order.speed);
      await arrows?.reach(player.time); // before the picture: it lasts no longer than the browser's turn
      if (order.camera === 'orbit') view.rig.swing(kOrbitRate / order.fps);
      view.changed();
      stage.drawFrame(1 / order.fps);
      if (order.samples > 1) await view.finishStill(order.samples);
      arrows?.draw(player.time);
      await video.add(frame / order.fps, 1 / order.fps);
      watch.progress(frame + 1, frames);
    }
    await output.finalize();
  } catch (error) {
    await output.cancel().catch(() => undefined);
    throw error;
  } finally {
    arrows?.close();
    stage.filming = false;
    view.stills = before.stills;
    player.time = before.time;
    stage.resized();
    stage.wake();
  }
  return new Uint8Array(target.buffer as ArrayBuffer);
}

function cutTo(stage: Stage, camera: 'front' | 'eye' | 'top'): void {
  const rig = stage.view!.rig;
  const { still } = rig;
  rig.still = true;
  stage.setWay(camera);
  rig.still = still;
}

async function soundTrack(output: Output, order: FilmOrder): Promise<AudioBufferSource | null> {
  const codec = await getFirstEncodableAudioCodec(order.format === 'mp4' ? ['aac', 'opus'] : ['opus', 'vorbis']);
  if (!codec) return null;
  const source = new AudioBufferSource({ codec, bitrate: 128e3 });
  output.addAudioTrack(source);
  return source;
}

/** Every hit at its moment of the film. */
async function soundOf(recording: Recording, order: FilmOrder, to: number): Promise<AudioBuffer> {
  const rate = 48000;
  const seconds = (to - order.from) / order.speed;
  const context = new OfflineAudioContext(1, Math.ceil(rate * (seconds + 0.05)), rate);
  const samples = clickSamples(rate);
  const buffer = context.createBuffer(1, samples.length, rate);
  buffer.copyToChannel(samples, 0);
  for (const click of clicksOf(recording)) {
    if (click.time < order.from || click.time > to) continue;
    const source = new AudioBufferSourceNode(context, { buffer, playbackRate: click.pitch });
    const gain = new GainNode(context, { gain: 0.35 * click.loudness });
    source.connect(gain).connect(context.destination);
    source.start((click.time - order.from) / order.speed);
  }
  return context.startRendering();
}
