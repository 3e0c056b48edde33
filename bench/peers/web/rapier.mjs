// Rapier as WebAssembly, z up.
// Tuned: lengths x 20, and its length unit with them a brick's height; 12 solver iterations instead of 4. Frictions are averaged, so the
// floor's 0.8 with a brick's 0.2 gives 0.5. The floor is a half-space, since a large box would lose digits.
// Could not be matched: WebAssembly without lanes costs it a factor against the native build; numbers are single precision.
import RAPIER from '@dimforge/rapier3d-compat';
import { run } from './peer.mjs';

await RAPIER.init({});

function make(scene) {
  const world = new RAPIER.World({ x: 0, y: 0, z: -scene.gravity });
  world.timestep = scene.timeStep;
  world.lengthUnit = 1;
  world.integrationParameters.numSolverIterations = 12;
  const floor = new RAPIER.ColliderDesc(new RAPIER.HalfSpace({ x: 0, y: 0, z: 1 }));
  floor.setFriction(2 * scene.floorFriction - scene.brickFriction);
  world.createCollider(floor);
  const bodies = [];
  return {
    add(index) {
      const { x, y, z, heading } = scene.bricks[index];
      const half = 0.5 * heading;
      const desc = RAPIER.RigidBodyDesc.dynamic()
        .setTranslation(x, y, z + 0.5 * scene.height)
        .setCanSleep(scene.sleeps)
        .setRotation({ x: 0, y: 0, z: Math.sin(half), w: Math.cos(half) });
      bodies[index] = world.createRigidBody(desc);
      const box = RAPIER.ColliderDesc.cuboid(0.5 * scene.thickness, 0.5 * scene.width, 0.5 * scene.height);
      world.createCollider(box.setFriction(scene.brickFriction).setRestitution(0), bodies[index]);
    },
    remove(index) {
      world.removeRigidBody(bodies[index]);
      bodies[index] = undefined;
    },
    setVelocity(index, [vx, vy, vz], [wx, wy, wz]) {
      bodies[index].setLinvel({ x: vx, y: vy, z: vz }, true);
      bodies[index].setAngvel({ x: wx, y: wy, z: wz }, true);
    },
    step() {
      world.step();
    },
    middle(index) {
      const { x, y, z } = bodies[index].translation();
      return [x, y, z];
    },
    upright(index) {
      const { x, y } = bodies[index].rotation();
      return 1 - 2 * (x * x + y * y);
    },
  };
}

run({ name: 'Rapier', version: RAPIER.version(), scale: 20, make });
