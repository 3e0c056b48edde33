/** The least a page with three.js can do with so many bricks: an InstancedMesh of boxes with a matrix each, one light with a shadow. To compare with. */

import { BoxGeometry, Color, DirectionalLight, HemisphereLight, InstancedMesh, Matrix4, MeshStandardMaterial, PCFShadowMap, PerspectiveCamera, Scene, WebGLRenderer } from 'three';

declare global {
  interface Window {
    plain: { frames: (feet: Float64Array, headings: Float64Array, frames: number) => Promise<{ frame: number; cost: number }> };
  }
}

window.plain = {
  /** Turns the camera for so many frames. @returns Median time from frame to frame, and that of the page's own thread in one [ms]. */
  frames: async (feet, headings, frames) => {
    const canvas = document.body.appendChild(document.createElement('canvas'));
    const renderer = new WebGLRenderer({ canvas });
    renderer.setSize(innerWidth, innerHeight);
    renderer.shadowMap.enabled = true;
    renderer.shadowMap.type = PCFShadowMap;
    const scene = new Scene();
    const sun = new DirectionalLight(0xffffff, 2.5);
    sun.castShadow = true;
    sun.shadow.mapSize.set(1024, 1024);
    scene.add(sun, new HemisphereLight(0xffffff, 0x888888, 2));
    const count = headings.length;
    const bricks = new InstancedMesh(new BoxGeometry(0.0075, 0.024, 0.048), new MeshStandardMaterial(), count);
    bricks.castShadow = bricks.receiveShadow = true;
    bricks.frustumCulled = false;
    let [x, y] = [0, 0];
    let reach = 0;
    const turn = new Matrix4();
    for (let i = 0; i < count; i++) {
      bricks.setMatrixAt(i, turn.makeRotationZ(headings[i]).setPosition(feet[3 * i], feet[3 * i + 1], feet[3 * i + 2] + 0.024));
      bricks.setColorAt(i, new Color(0xd92b2b));
      x += feet[3 * i] / count;
      y += feet[3 * i + 1] / count;
    }
    for (let i = 0; i < count; i++) reach = Math.max(reach, Math.hypot(feet[3 * i] - x, feet[3 * i + 1] - y));
    scene.add(bricks);
    const camera = new PerspectiveCamera(40, innerWidth / innerHeight, 0.001 * reach, 10 * reach);
    camera.up.set(0, 0, 1);
    Object.assign(sun.shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.1 * reach, far: 6 * reach });
    sun.position.set(x - reach, y + 2 * reach, 2 * reach);
    sun.target.position.set(x, y, 0);
    scene.add(sun.target);
    const times: number[] = [];
    const costs: number[] = [];
    let last = performance.now();
    for (let frame = 0; frame < frames + 2; frame++) {
      await new Promise((next) => requestAnimationFrame(next));
      const now = performance.now();
      if (frame > 1) times.push(now - last);
      last = now;
      camera.position.set(x + 1.6 * reach * Math.cos(0.1 * frame), y + 1.6 * reach * Math.sin(0.1 * frame), 1.2 * reach);
      camera.lookAt(x, y, 0);
      renderer.render(scene, camera);
      costs.push(performance.now() - now);
    }
    const median = (values: number[]): number => values.sort((a, b) => a - b)[Math.floor(values.length / 2)];
    renderer.dispose();
    return { frame: median(times), cost: median(costs) };
  },
};
