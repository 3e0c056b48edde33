// Jolt Physics as WebAssembly, single-threaded, z up.
// Tuned: lengths x 50, so that its penetration slop of 20 mm and its speculative distance are 5 % of a thickness; both are cut to a tenth
// besides. Convex radius 0. 20 velocity steps instead of 10. Friction is mixed as the root of a product, so the floor's 1.25 with a brick's
// 0.2 gives 0.5. Bodies may sleep.
// Could not be matched: WebAssembly costs it a factor against the native build; numbers are single precision.
import { createRequire } from 'node:module';
import initJolt from 'jolt-physics';
import { run } from './peer.mjs';

const Jolt = await initJolt();
const kStill = 0;
const kMoving = 1;

function makeInterface(bodies) {
  const settings = new Jolt.JoltSettings();
  const pairs = new Jolt.ObjectLayerPairFilterTable(2);
  pairs.EnableCollision(kStill, kMoving);
  pairs.EnableCollision(kMoving, kMoving);
  const layers = new Jolt.BroadPhaseLayerInterfaceTable(2, 2);
  layers.MapObjectToBroadPhaseLayer(kStill, new Jolt.BroadPhaseLayer(0));
  layers.MapObjectToBroadPhaseLayer(kMoving, new Jolt.BroadPhaseLayer(1));
  settings.mObjectLayerPairFilter = pairs;
  settings.mBroadPhaseLayerInterface = layers;
  settings.mObjectVsBroadPhaseLayerFilter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(layers, 2, pairs, 2);
  settings.mMaxBodies = bodies + 16;
  // Its memory for a step is of one size, so these are not more than it has room for: those of a few thousand bricks that move at once.
  settings.mMaxBodyPairs = Math.min(8 * bodies + 1024, 16384);
  settings.mMaxContactConstraints = Math.min(4 * bodies + 1024, 8192);
  return new Jolt.JoltInterface(settings);
}

function make(scene) {
  const jolt = makeInterface(scene.bricks.length);
  const system = jolt.GetPhysicsSystem();
  system.SetGravity(new Jolt.Vec3(0, 0, -scene.gravity));
  const settings = system.GetPhysicsSettings();
  settings.mPenetrationSlop = 0.002;
  settings.mSpeculativeContactDistance = 0.002;
  settings.mNumVelocitySteps = 20;
  system.SetPhysicsSettings(settings);
  const bodyInterface = system.GetBodyInterface();
  const identity = new Jolt.Quat(0, 0, 0, 1);

  // A floor of many boxes would have seams; one that is long enough keeps its top face at zero.
  const last = scene.bricks.reduce((most, { x, y }) => Math.max(most, Math.abs(x), Math.abs(y)), 0) + 10 * scene.height;
  const floorShape = new Jolt.BoxShape(new Jolt.Vec3(last, last, 1), 0);
  const floor = new Jolt.BodyCreationSettings(floorShape, new Jolt.RVec3(0, 0, -1), identity, Jolt.EMotionType_Static, kStill);
  floor.mFriction = (scene.floorFriction * scene.floorFriction) / scene.brickFriction;
  bodyInterface.CreateAndAddBody(floor, Jolt.EActivation_DontActivate);

  const shape = new Jolt.BoxShape(new Jolt.Vec3(0.5 * scene.thickness, 0.5 * scene.width, 0.5 * scene.height), 0);
  const bodies = [];
  return {
    add(index) {
      const { x, y, z, heading } = scene.bricks[index];
      const place = new Jolt.RVec3(x, y, z + 0.5 * scene.height);
      const turn = new Jolt.Quat(0, 0, Math.sin(0.5 * heading), Math.cos(0.5 * heading));
      const creation = new Jolt.BodyCreationSettings(shape, place, turn, Jolt.EMotionType_Dynamic, kMoving);
      creation.mFriction = scene.brickFriction;
      creation.mRestitution = 0;
      creation.mAllowSleeping = scene.sleeps;
      creation.mLinearDamping = 0;
      creation.mAngularDamping = 0;
      bodies[index] = bodyInterface.CreateBody(creation);
      bodyInterface.AddBody(bodies[index].GetID(), scene.pushed.has(index) || !scene.sleeps ? Jolt.EActivation_Activate : Jolt.EActivation_DontActivate);
      for (const part of [place, turn, creation]) Jolt.destroy(part);
    },
    remove(index) {
      const id = bodies[index].GetID();
      bodyInterface.RemoveBody(id);
      bodyInterface.DestroyBody(id);
      bodies[index] = undefined;
    },
    setVelocity(index, linear, angular) {
      bodyInterface.SetLinearAndAngularVelocity(bodies[index].GetID(), new Jolt.Vec3(...linear), new Jolt.Vec3(...angular));
    },
    step() {
      jolt.Step(scene.timeStep, 1);
    },
    middle(index) {
      const place = bodies[index].GetPosition();
      return [place.GetX(), place.GetY(), place.GetZ()];
    },
    upright(index) {
      const turn = bodies[index].GetRotation();
      const [x, y] = [turn.GetX(), turn.GetY()];
      return 1 - 2 * (x * x + y * y);
    },
  };
}

const { version } = createRequire(import.meta.url)('./node_modules/jolt-physics/package.json');
run({ name: 'Jolt', version, scale: 50, make });
