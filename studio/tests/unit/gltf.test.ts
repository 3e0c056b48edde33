/** Animated scenes as `topple export` writes them: the format's own validator finds nothing, and three.js moves the bricks as the page does. */

import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { validateBytes } from 'gltf-validator';
import { AnimationMixer, Quaternion, Vector3, type Object3D } from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { describe, expect, test } from 'vitest';
import { decodeRecording } from '../../src/recording/decode.ts';
import { Playhead } from '../../src/recording/playhead.ts';

const kRoot = fileURLToPath(new URL('../../../', import.meta.url));
const kProgram = process.env.TOPPLE_PROGRAM ?? join(kRoot, 'build/release/topple');

/** Of a run by a model, its recording and its scene. */
function made(scene: string, model: string, options: string[] = []): { recording: Uint8Array; glb: Uint8Array } {
  const folder = mkdtempSync(join(tmpdir(), 'topple-gltf-'));
  try {
    const [run, glb] = [join(folder, 'run.topple'), join(folder, 'run.glb')];
    execFileSync(kProgram, ['run', `${kRoot}scenes/${scene}`, '--model', model, '--out', run], { stdio: 'ignore' });
    execFileSync(kProgram, ['export', run, '-o', glb, ...options], { stdio: 'ignore' });
    return { recording: new Uint8Array(readFileSync(run)), glb: new Uint8Array(readFileSync(glb)) };
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

describe.skipIf(!existsSync(kProgram))('an exported scene', () => {
  test.each([
    ['fronts.toml', 'rigid', 1e-4],
    ['curve_u.toml', 'hinge', 0.002],
  ])('%s by %s is valid, and moves in three.js as in the page', async (scene, model, tolerance) => {
    const { recording: bytes, glb } = made(scene, model);
    const { issues } = await validateBytes(glb);
    expect(issues.messages).toEqual([]);

    const recording = decodeRecording(bytes);
    const playhead = new Playhead(recording);
    const gltf = await new GLTFLoader().parseAsync(glb.buffer as ArrayBuffer, '');
    const mixer = new AnimationMixer(gltf.scene);
    mixer.clipAction(gltf.animations[0]).play();
    const bricks: Object3D[] = [];
    gltf.scene.traverse((node) => {
      if ('brick' in node.userData) bricks[node.userData.brick as number] = node;
    });
    expect(bricks.filter(Boolean).length).toBe(recording.bricks.count);

    // In glTF y is up; a corner is as far off as its centre and the turn of what is farthest from it.
    const [place, turn] = [new Vector3(), new Quaternion()];
    let worst = 0;
    for (let time = 0; time < gltf.animations[0].duration; time += 0.0371) {
      mixer.setTime(time);
      gltf.scene.updateMatrixWorld(true);
      playhead.moveTo(time);
      for (const [brick, node] of bricks.entries()) {
        const { thickness, width, height } = recording.kinds[recording.bricks.kind[brick]];
        const [x, y, z] = playhead.position.subarray(3 * brick, 3 * brick + 3);
        const [qx, qy, qz, qw] = playhead.turn.subarray(4 * brick, 4 * brick + 4);
        const away = node.getWorldPosition(place).distanceTo(new Vector3(x, z, -y));
        // From one orientation to the other: for a small angle its sine, of which the vector part has half.
        const { x: u, y: v, z: w } = node.getWorldQuaternion(turn).multiply(new Quaternion(-qx, -qz, qy, qw));
        worst = Math.max(worst, (away + Math.hypot(u, v, w) * Math.hypot(thickness, width, height)) / thickness);
      }
    }
    expect(worst).toBeLessThan(tolerance);
  });

  test('straight keyframes are valid too', async () => {
    const { issues } = await validateBytes(made('report_returns.toml', 'pivot', ['--fps', '24']).glb);
    expect(issues.messages).toEqual([]);
  });
});
