// What both WebAssembly engines do here: the same bricks, pushed and timed as peer.cpp does it for the others.
// usage: node ENGINE.mjs BRICKS RATE_HZ WINDOW LIMIT_S [STAND_S], see peer.cpp.
import { readFileSync } from 'node:fs';

const kArrivalTilt = Math.PI / 18;
const kPush = 4;
const kAfter = 0.5;
const kAhead = 8;

function readScene(path, scale, rate) {
  const lines = readFileSync(path, 'utf8').trim().split('\n');
  const [height, width, thickness] = lines[0].split(' ').map((word) => Number(word) * scale);
  const rows = [];
  let last;
  const bricks = lines.slice(1).map((line, index) => {
    const [x, y, z, heading, row] = line.split(' ').map(Number);
    if (row !== last) rows.push(index);
    last = row;
    return { x: x * scale, y: y * scale, z: z * scale, heading };
  });
  const pushed = new Set(rows);
  rows.push(bricks.length);
  // Gravity stays, so times grow as the root of lengths.
  const timeStep = Math.sqrt(scale) / rate;
  return { height, width, thickness, bricks, rows, pushed, gravity: 9.81, timeStep, brickFriction: 0.2, floorFriction: 0.5 };
}

const cpuNow = () => {
  const { user, system } = process.cpuUsage();
  return (user + system) * 1e-6;
};
const tilt = (world, brick) => Math.acos(Math.min(1, Math.max(-1, world.upright(brick))));

// The wave along one row, from brick to brick in the order of the file.
function makeWave(world, first, end, window) {
  const arrivals = [];
  let [added, removed, lastTilt] = [first, first, 0];
  const addUpTo = (limit) => {
    while (added < Math.min(end, limit)) world.add(added++);
  };
  addUpTo(window === 0 ? end : first + kAhead);
  return {
    first,
    arrivals,
    done: () => first + arrivals.length === end,
    // After a step that ended at a time; whether a brick was reached in it.
    look(time, rate) {
      const before = arrivals.length;
      while (first + arrivals.length < end) {
        const now = tilt(world, first + arrivals.length);
        if (now < kArrivalTilt) {
          lastTilt = now;
          break;
        }
        const share = now > lastTilt ? (now - kArrivalTilt) / (now - lastTilt) : 0;
        arrivals.push(time - share / rate);
        lastTilt = 0;
        if (window === 0) continue;
        addUpTo(first + arrivals.length + kAhead);
        while (removed + window < first + arrivals.length) world.remove(removed++);
      }
      return arrivals.length > before;
    },
  };
}

function push(world, scene, rate, index) {
  const { heading } = scene.bricks[index];
  const speed = kPush / (scene.timeStep * rate);
  const ahead = 0.5 * speed * scene.height;
  world.setVelocity(
    index,
    [ahead * Math.cos(heading), ahead * Math.sin(heading), 0.5 * speed * scene.thickness],
    [-speed * Math.sin(heading), speed * Math.cos(heading), 0],
  );
}

function follow(world, scene, rate, window, limit) {
  const waves = scene.rows.slice(0, -1).map((first, row) => {
    const wave = makeWave(world, first, scene.rows[row + 1], window);
    push(world, scene, rate, first);
    return wave;
  });
  let last = 0;
  const begin = cpuNow();
  for (let step = 1; ; ++step) {
    world.step();
    const time = step / rate;
    for (const wave of waves) if (wave.look(time, rate)) last = time;
    const cut = cpuNow() - begin > limit;
    if (cut || time > last + (waves.every((wave) => wave.done()) ? kAfter : 2)) return { waves, cut, stood: 0, drift: 0 };
  }
}

function stand(world, scene, rate, seconds, limit) {
  const places = scene.bricks.map((_, index) => {
    world.add(index);
    return world.middle(index);
  });
  const begin = cpuNow();
  let cut = false;
  let stood = 0;
  for (let step = 1; step <= seconds * rate && !cut; ++step) {
    world.step();
    stood = step / rate;
    cut = cpuNow() - begin > limit;
  }
  const ways = places.map((place, index) => Math.hypot(...world.middle(index).map((now, axis) => now - place[axis])));
  return { waves: [], cut, stood, drift: Math.max(...ways) / scene.thickness };
}

function pathLength({ bricks }, from, to) {
  let length = 0;
  for (let i = from; i < to; ++i) length += Math.hypot(bricks[i + 1].x - bricks[i].x, bricks[i + 1].y - bricks[i].y);
  return length;
}

function hashOf(arrivals) {
  const words = new BigUint64Array(Float64Array.from(arrivals).buffer);
  const mask = (1n << 64n) - 1n;
  let hash = 0x243f6a8885a308d3n;
  for (const word of words) {
    hash = ((hash ^ word) * 0x9e3779b97f4a7c15n) & mask;
    hash ^= hash >> 29n;
  }
  return hash.toString(16).padStart(16, '0');
}

// Mean over the rows of the speed between 20 % and 80 % of the bricks that were reached, since a run may be cut [m/s].
function frontSpeed(scene, waves, scale) {
  const speeds = waves.flatMap(({ first, arrivals }) => {
    const from = Math.floor(arrivals.length / 5);
    const to = Math.floor((arrivals.length * 4) / 5);
    return to > from ? [pathLength(scene, first + from, first + to) / scale / (arrivals[to] - arrivals[from])] : [];
  });
  return speeds.length > 0 ? speeds.reduce((sum, speed) => sum + speed, 0) / speeds.length : 0;
}

/** `make(scene)` gives a world with add, remove, setVelocity, step, middle and upright; `scale`: lengths in the engine over true lengths. */
export function run({ name, version, scale, make }) {
  const [path, rateWord, windowWord, limitWord, standWord] = process.argv.slice(2);
  const rate = Number(rateWord);
  const scene = readScene(path, scale, rate);
  scene.sleeps = standWord === undefined;
  const begin = cpuNow();
  const world = make(scene);
  const limit = Number(limitWord);
  const { waves, cut, stood, drift } = scene.sleeps
    ? follow(world, scene, rate, Number(windowWord), limit)
    : stand(world, scene, rate, Number(standWord), limit);
  const cpu = cpuNow() - begin;
  const numbers = waves.flatMap(({ arrivals }) => arrivals).concat(scene.sleeps ? [] : [drift]);
  const result = {
    engine: name,
    version,
    bricks: scene.bricks.length,
    arrived: waves.reduce((sum, { arrivals }) => sum + arrivals.length, 0),
    cpu_s: cpu,
    front_speed_m_s: frontSpeed(scene, waves, scale),
    drift,
    stood_s: stood,
    cut,
    hash: hashOf(numbers),
  };
  console.log(JSON.stringify(result));
  process.exit(0);
}
