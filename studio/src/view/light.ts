/**
 * A warm low sun from behind on the left, and a cool sky. Live, the sky is a plain hemisphere; for a still, each averaged frame lights
 * it from one direction with a shadow of its own, which makes true ambient occlusion, and the sun has a breadth.
 */

import {
  DirectionalLight, HemisphereLight, Matrix4, PCFShadowMap, Vector3,
  type OrthographicCamera, type PerspectiveCamera, type Scene, type WebGLRenderer,
} from 'three';

/** Colours and strengths; linear, tuned by eye against the pictures of the design. */
export interface Mood {
  sun: number;
  sunColor: number;
  sky: number;
  skyColor: number;
  bounce: number;
  /** Of what is mirrored in the bricks. */
  surroundings: number;
}
export const kMoods: Record<'light' | 'dark', Mood> = {
  light: { sun: 2.75, sunColor: 0xffdfba, sky: 2.75, skyColor: 0xe4ecff, bounce: 0xb5a999, surroundings: 1.0 },
  dark: { sun: 2.6, sunColor: 0xffdcb4, sky: 1.7, skyColor: 0xc4d6ff, bounce: 0x3a3d45, surroundings: 0.55 },
};

/** Breadth of the sun: how far its direction strays in a still. */
const kSunBreadth = 0.045;

export class Light {
  private readonly sun = new DirectionalLight();
  private readonly skyRay = new DirectionalLight();
  private readonly dome = new HemisphereLight();
  private readonly towardsSun = new Vector3(0, 0, 1);
  private mood: Mood = kMoods.light;

  constructor(
    scene: Scene,
    renderer: WebGLRenderer,
    shadowSize: number,
  ) {
    renderer.shadowMap.enabled = true;
    renderer.shadowMap.type = PCFShadowMap;
    renderer.shadowMap.autoUpdate = false;
    for (const light of [this.sun, this.skyRay]) {
      light.castShadow = true;
      light.shadow.mapSize.set(shadowSize, shadowSize);
      scene.add(light, light.target);
    }
    this.sun.shadow.radius = 2.5;
    this.skyRay.shadow.radius = 1.5;
    this.dome.position.set(0, 0, 1);
    scene.add(this.dome);
    this.setMood(kMoods.light);
    this.useLive();
  }

  setMood(mood: Mood): void {
    this.mood = mood;
    this.sun.color.set(mood.sunColor);
    this.sun.intensity = mood.sun;
    this.skyRay.color.set(mood.skyColor);
    this.dome.color.set(mood.skyColor);
    this.dome.groundColor.set(mood.bounce);
  }

  /** Puts the sun behind what a camera looking along `forward` sees, on its left; there it stays however the camera turns. */
  placeSun(forward: Vector3): void {
    const ahead = new Vector3(forward.x, forward.y, 0).normalize();
    const left = new Vector3(-ahead.y, ahead.x, 0);
    this.towardsSun.copy(ahead).multiplyScalar(0.42).addScaledVector(left, 0.8).setZ(0.72).normalize();
  }

  useLive(): void {
    this.skyRay.visible = false;
    this.skyRay.castShadow = false;
    this.dome.intensity = this.mood.sky;
  }

  /** Lights one averaged frame. @param spread Numbers 4 to 7 are used, each spread evenly over 0 to 1. */
  useSample(spread: number[]): { sun: Vector3; sky: Vector3 } {
    const [, , , , c, d, a, b] = spread;
    this.skyRay.visible = true;
    this.skyRay.castShadow = true;
    this.dome.intensity = 0.22 * this.mood.sky;
    this.skyRay.intensity = 1.05 * this.mood.sky;
    const sun = this.towardsSun.clone();
    const side = new Vector3(-sun.y, sun.x, 0).normalize();
    const up = new Vector3().crossVectors(sun, side);
    const stray = kSunBreadth * Math.sqrt(a);
    sun.addScaledVector(side, stray * Math.cos(2 * Math.PI * b)).addScaledVector(up, stray * Math.sin(2 * Math.PI * b)).normalize();
    const flat = Math.sqrt(c); // cosine-weighted over the sky
    const sky = new Vector3(flat * Math.cos(2 * Math.PI * d), flat * Math.sin(2 * Math.PI * d), Math.sqrt(Math.max(0.02, 1 - c)));
    return { sun, sky: sky.normalize() };
  }

  /**
   * Fits the shadow maps to the part of the table that the camera sees.
   * @param reach How high bricks stand, and how far beyond the visible part one may throw its shadow [m].
   */
  fit(camera: PerspectiveCamera, bounds: Bounds, reach: number, directions?: { sun: Vector3; sky: Vector3 }): void {
    const seen = visibleCorners(camera, bounds, reach);
    fitTo(this.sun, directions?.sun ?? this.towardsSun, seen, reach);
    if (directions) fitTo(this.skyRay, directions.sky, seen, reach);
  }
}

/** The box that holds all bricks [m]. */
export interface Bounds {
  low: Vector3;
  high: Vector3;
}

/** Corners of a volume that holds all bricks which may be seen or throw a shadow that is. */
function visibleCorners(camera: PerspectiveCamera, bounds: Bounds, reach: number): Vector3[] {
  const low = new Vector3(Infinity, Infinity, 0);
  const high = new Vector3(-Infinity, -Infinity, reach);
  const ray = new Vector3();
  const farthest = 60 * Math.max(reach, camera.position.z);
  for (const x of [-1, 0, 1]) {
    for (const y of [-1, 0, 1]) {
      ray.set(x, y, 0.5).unproject(camera).sub(camera.position).normalize();
      const way = ray.z < -1e-4 ? Math.min(farthest, -camera.position.z / ray.z) : farthest;
      low.x = Math.min(low.x, camera.position.x + ray.x * way);
      low.y = Math.min(low.y, camera.position.y + ray.y * way);
      high.x = Math.max(high.x, camera.position.x + ray.x * way);
      high.y = Math.max(high.y, camera.position.y + ray.y * way);
    }
  }
  const margin = 2 * reach;
  low.set(Math.max(low.x, bounds.low.x) - margin, Math.max(low.y, bounds.low.y) - margin, 0);
  high.set(Math.min(high.x, bounds.high.x) + margin, Math.min(high.y, bounds.high.y) + margin, Math.max(reach, bounds.high.z));
  return [0, 1, 2, 3, 4, 5, 6, 7].map(
    (i) => new Vector3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z),
  );
}

function fitTo(light: DirectionalLight, direction: Vector3, corners: Vector3[], reach: number): void {
  const middle = corners[0].clone().add(corners[7]).multiplyScalar(0.5);
  const camera: OrthographicCamera = light.shadow.camera;
  const turn = new Matrix4().lookAt(direction, new Vector3(), new Vector3(0.01, 0.02, 1));
  const inverse = turn.clone().invert();
  const low = new Vector3(Infinity, Infinity, Infinity);
  const high = new Vector3(-Infinity, -Infinity, -Infinity);
  for (const corner of corners) {
    const seen = corner.clone().sub(middle).applyMatrix4(inverse);
    low.min(seen);
    high.max(seen);
  }
  const half = new Vector3().subVectors(high, low).multiplyScalar(0.5);
  const distance = half.z + 10 * reach;
  light.target.position.copy(middle);
  light.position.copy(middle).addScaledVector(direction, distance);
  camera.up.set(0.01, 0.02, 1);
  camera.left = low.x;
  camera.right = high.x;
  camera.bottom = low.y;
  camera.top = high.y;
  camera.near = Math.max(0.001, distance - half.z - 4 * reach);
  camera.far = distance + half.z + 4 * reach;
  camera.updateProjectionMatrix();
  const texel = Math.max(half.x, half.y) * 2 / light.shadow.mapSize.x;
  light.shadow.normalBias = Math.min(0.004, 0.5 * texel);
  light.shadow.bias = -0.00012;
  light.target.updateMatrixWorld();
}
