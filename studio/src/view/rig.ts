/** The camera and its four ways: orbit (free), front (follows the wave), eye (low beside a brick), top. */

import { MathUtils, MOUSE, PerspectiveCamera, TOUCH, Vector3 } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { defaultDirection, frame, type Aim, type Insets } from './framing.ts';

export type Way = 'orbit' | 'front' | 'eye' | 'top';

const kFlight = 0.55;
/** The part of a camera's distance to which coming nearer is worth a flight. */
const kMuchNearer = 0.8;
/** How far down the free camera must look for its way of looking to be kept: beside a brick, and from straight above, it has none. */
const kFlattest = -0.15;
const kSteepest = -0.985;
/** Bricks lower than this part of the view are no longer seen to fall. */
const kSpeck = 0.008;
/** How fast the camera closes in on the front [1/s]. */
const kFollow = 5;

const kNoInsets: Insets = { left: 0, right: 0, top: 0, bottom: 0 };

/** Over the table as one draws: x to the right. */
const kTableForward = new Vector3(0, 0.7, -0.72);

/** A camera to come back to. */
interface Left {
  aim: Aim;
  way: Way;
  framed: boolean;
  /** All bricks were in sight. */
  whole: boolean;
}

/** A place on the table and the way a brick there heads. */
export interface Spot {
  place: Vector3;
  heading: number;
}

export class Rig {
  readonly camera = new PerspectiveCamera(30, 1.5, 0.01, 100);
  readonly controls: OrbitControls;
  way: Way = 'orbit';
  insets: Insets = { left: 0.04, right: 0.04, top: 0.13, bottom: 0.07 };
  /** Which way to look when all bricks are framed, instead of the way that suits them. */
  forward: Vector3 | null = null;
  /** Cut instead of flying. */
  still = matchMedia('(prefers-reduced-motion: reduce)').matches;
  /** All bricks are in view and nobody has moved the camera since: it keeps them in view when the page changes its size. */
  private framed = true;
  private drawing = false;
  /** The table as it was drawn on, to come back to; null once somebody has moved the camera since. */
  private table: Left | null = null;
  /** The free camera while another way has its place. */
  private free: Left | null = null;
  private flight: { from: Aim; to: Aim; part: number } | null = null;

  /**
   * @param points Feet and tops of bricks, enough to frame the run by.
   * @param brickHeight Of a usual brick [m].
   */
  constructor(
    element: HTMLElement,
    private points: Vector3[],
    private brickHeight: number,
    changed: () => void,
  ) {
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, element);
    this.controls.enableDamping = !this.still;
    this.controls.dampingFactor = 0.12;
    this.controls.maxPolarAngle = 1.53;
    this.controls.minDistance = 0.6 * brickHeight;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', changed);
    this.controls.addEventListener('start', () => {
      this.flight = null;
      this.framed = false;
      if (!this.drawing) this.table = null;
    });
  }

  /** Other bricks: the camera stays where it is. */
  setPoints(points: Vector3[], brickHeight: number): void {
    this.points = points;
    this.brickHeight = brickHeight;
    this.controls.minDistance = 0.6 * brickHeight;
    this.framed = false;
  }

  /** While drawing the left button and one finger draw; the right button, the wheel and two fingers move the camera. */
  setDrawing(drawing: boolean): void {
    if (this.drawing !== drawing) this.exchange(drawing);
    this.drawing = drawing;
    this.controls.mouseButtons = drawing ? { LEFT: null, MIDDLE: MOUSE.PAN, RIGHT: MOUSE.ROTATE } : { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN };
    this.controls.touches = drawing ? { ONE: null, TWO: TOUCH.DOLLY_PAN } : { ONE: TOUCH.ROTATE, TWO: TOUCH.DOLLY_PAN };
  }

  /** For drawing the camera goes back to where it was, unless somebody has moved it since; and never stays beside a brick. */
  private exchange(drawing: boolean): void {
    if (!drawing) {
      this.table = this.now();
      return;
    }
    if (this.table) this.comeBack(this.table);
    else if (this.way !== 'top') this.orbit();
    this.table = null;
  }

  /** Where the camera is, or flies to. */
  private now(): Left {
    const { position, target } = this.flight?.to ?? { position: this.camera.position, target: this.controls.target };
    return { aim: { position: position.clone(), target: target.clone() }, way: this.way, framed: this.framed, whole: this.whole() };
  }

  private comeBack(left: Left): void {
    this.way = left.way;
    this.controls.zoomToCursor = left.way !== 'front';
    this.goTo(left.aim);
    this.framed = left.framed;
  }

  /** Keeps the free camera's place for when one comes back to it. */
  private leave(way: Way): void {
    if (this.way === 'orbit') this.free = this.now();
    this.way = way;
  }

  get distance(): number {
    return this.camera.position.distanceTo(this.controls.target);
  }

  get flying(): boolean {
    return this.flight !== null;
  }

  resize(aspect: number): void {
    this.camera.aspect = aspect;
    this.camera.updateProjectionMatrix();
    if (this.framed) this.frameAll(true);
  }

  private goTo(aim: Aim, cut = false): void {
    this.framed = false;
    const from = { position: this.camera.position.clone(), target: this.controls.target.clone() };
    this.flight = { from, to: aim, part: cut || this.still ? 1 : 0 };
    if (this.flight.part === 1) this.advance(0);
  }

  /** To a place at once. */
  cut(aim: Aim): void {
    this.goTo(aim, true);
  }

  private look(aim: Aim): void {
    this.camera.position.copy(aim.position);
    this.controls.target.copy(aim.target);
    this.fitDepth();
    this.controls.update();
  }

  /** Near and far planes for what is seen: depth keeps its precision from a brick's eye to a run of kilometres. */
  private fitDepth(): void {
    const farthest = this.distance * 30 + 4 * this.radius();
    this.camera.near = Math.max(0.002, Math.min(0.02, 0.1 * this.distance), farthest / 60000);
    this.camera.far = farthest;
    this.controls.maxDistance = 14 * (this.radius() + this.brickHeight * 8);
    this.camera.updateProjectionMatrix();
  }

  private radius(): number {
    let most = 0;
    for (const point of this.points) most = Math.max(most, point.length());
    return most;
  }

  /** Moves on by `dt` [s]; `front` is where the wave is, null when there is none. */
  advance(dt: number, front: Vector3 | null = null): boolean {
    let moved = false;
    if (this.flight) {
      const { from, to } = this.flight;
      this.flight.part = Math.min(1, this.flight.part + dt / kFlight);
      const s = this.flight.part;
      const ease = s * s * s * (s * (6 * s - 15) + 10);
      this.look({ position: from.position.clone().lerp(to.position, ease), target: from.target.clone().lerp(to.target, ease) });
      if (s === 1) this.flight = null;
      moved = true;
    } else if (this.way === 'front' && front) {
      moved = this.follow(front, dt);
    }
    this.fitDepth();
    return this.controls.update(dt) || moved;
  }

  private follow(front: Vector3, dt: number): boolean {
    const gap = front.clone().sub(this.controls.target);
    if (gap.length() < 1e-5) return false;
    const jump = gap.length() > 4 * this.distance;
    gap.multiplyScalar(jump || dt === 0 || this.still ? 1 : 1 - Math.exp(-kFollow * dt));
    this.controls.target.add(gap);
    this.camera.position.add(gap);
    return true;
  }

  /** All bricks in view, from the side from which they are seen now. @param fresh Another run: from the side that suits it. */
  frameAll(cut = false, fresh = false): void {
    const top = this.way === 'top';
    const forward = top ? new Vector3(0, 1e-3, -1) : ((fresh ? null : this.tableForward()) ?? this.defaultForward());
    if (fresh) this.free = null;
    this.goTo(frame(this.points, forward, this.camera, this.insets), cut);
    this.framed = true;
  }

  /** Which way the free camera looks, if it looks down on the table; null: along it, straight down, or nowhere yet. */
  tableForward(): Vector3 | null {
    const { position, target } = (this.way === 'orbit' ? this.now() : (this.free ?? this.now())).aim;
    const forward = target.clone().sub(position);
    if (forward.length() < 1e-9) return null;
    forward.normalize();
    return forward.z < kFlattest && forward.z > kSteepest ? forward : null;
  }

  /** Whether all bricks are in sight, and keep clear of what covers such parts of the view. */
  private whole({ left, right, top, bottom }: Insets = kNoInsets): boolean {
    this.camera.updateMatrixWorld();
    return this.points.every((point) => {
      const at = point.clone().project(this.camera);
      return at.x > 2 * left - 1 && at.x < 1 - 2 * right && at.y > 2 * bottom - 1 && at.y < 1 - 2 * top && at.z < 1;
    });
  }

  /**
   * Nearer from the same side, if all bricks were in sight and would be much larger: what is drawn needs room, what falls is looked at.
   * Back, if the page's other shape has cut some of them off or covers them.
   * @returns Whether bricks in sight can be seen from there: a run of many metres is a line.
   */
  closeIn(): boolean {
    if (this.framed || this.way !== 'orbit') return true;
    const whole = this.whole();
    if (!whole && !this.table?.whole) return true;
    const aim = frame(this.points, this.controls.target.clone().sub(this.camera.position), this.camera, this.insets);
    if (this.sizeAt(aim.position.distanceTo(aim.target)) < kSpeck) return false;
    const covered = !this.whole(this.insets);
    if (!whole || covered || aim.position.distanceTo(aim.target) < kMuchNearer * this.distance) this.goTo(aim);
    return true;
  }

  /** A brick's height as a part of the view's, so far away. */
  sizeAt(distance: number): number {
    return this.brickHeight / (2 * Math.tan(MathUtils.degToRad(this.camera.fov) / 2) * distance);
  }

  defaultForward(): Vector3 {
    if (this.forward) return this.forward.clone();
    return this.drawing ? kTableForward.clone() : defaultDirection(this.points);
  }

  /** The free camera, where it was left. */
  orbit(): void {
    if (this.way === 'orbit') return;
    const { free } = this;
    this.free = null;
    this.way = 'orbit';
    this.controls.zoomToCursor = true;
    if (free) this.comeBack(free);
  }

  top(): void {
    this.leave('top');
    this.controls.zoomToCursor = true;
    this.frameAll();
  }

  /** Rides beside the wave, a little ahead of it, looking back at the bricks that fall. */
  followFront(spot: Spot): void {
    this.leave('front');
    this.controls.zoomToCursor = false;
    const reach = 9.5 * this.brickHeight;
    const target = spot.place.clone().setZ(0.35 * this.brickHeight);
    const ahead = new Vector3(Math.cos(spot.heading), Math.sin(spot.heading), 0);
    const side = new Vector3(-ahead.y, ahead.x, 0);
    const from = ahead.multiplyScalar(0.62).addScaledVector(side, this.sideOf(target, side)).setZ(0.42).normalize();
    this.goTo({ position: target.clone().addScaledVector(from, reach), target });
  }

  /** Turns the camera about what it looks at [rad]. */
  swing(angle: number): void {
    const arm = this.camera.position.clone().sub(this.controls.target).applyAxisAngle(new Vector3(0, 0, 1), angle);
    this.camera.position.copy(this.controls.target).add(arm);
    this.controls.update();
  }

  /** Near a place, from where the camera is now. */
  closeUp(spot: Spot): void {
    const from = this.camera.position.clone().sub(this.controls.target).normalize();
    from.setZ(Math.max(from.z, 0.35)).normalize();
    this.goTo({ position: spot.place.clone().addScaledVector(from, 12 * this.brickHeight), target: spot.place.clone() });
  }

  /** The side of a row on which the camera is now, so that it need not cross over. */
  private sideOf(target: Vector3, side: Vector3): number {
    return this.camera.position.clone().sub(target).dot(side) >= 0 ? 0.78 : -0.78;
  }

  /** Low beside a brick, at the height of its eye, looking back along the run at what is coming. */
  brickEye(spot: Spot): void {
    this.leave('eye');
    this.controls.zoomToCursor = true;
    const h = this.brickHeight;
    const ahead = new Vector3(Math.cos(spot.heading), Math.sin(spot.heading), 0);
    const side = new Vector3(-ahead.y, ahead.x, 0).multiplyScalar(Math.sign(this.sideOf(spot.place, new Vector3(-ahead.y, ahead.x, 0))));
    const position = spot.place.clone().addScaledVector(ahead, 2.2 * h).addScaledVector(side, 1.25 * h).setZ(0.62 * h);
    const target = spot.place.clone().addScaledVector(ahead, -4.5 * h).addScaledVector(side, -0.2 * h).setZ(0.42 * h);
    this.goTo({ position, target });
  }

  dispose(): void {
    this.controls.dispose();
  }
}
