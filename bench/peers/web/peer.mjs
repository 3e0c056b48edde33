// What both WebAssembly engines do here: the same bricks, pushed and timed as peer.cpp does it for the others.
// usage: node ENGINE.mjs BRICKS RATE_HZ WINDOW LIMIT_S, see peer.cpp.
import { readFileSync } from 'node:fs';

const kArrivalTilt = Math.PI / 18;
const kPush = 4;
const kAfter = 0.5;
const kAhead = 8;

function readScene(path, scale, rate) {
  const lines = readFileSync(path, 'utf8').trim().split('\n');
  const [height, width, thickness] = lines[0].split(' ').map((word) => Number(word) * scale);
  const bricks = lines.slice(1).map((line) => {
    const [x, y, heading] = line.split(' ').map(Number);
    return { x: x * scale, y: y * scale, heading };
  });
  // Gravity stays, so times grow as the root of lengths.
  return { height, width, thickness, bricks, gravity: 9.81, timeStep: Math.sqrt(scale) / rate, brickFriction: 0.2, floorFriction: 0.5 };
}

const cpuNow = () => {
  const { user, system } = process.cpuUsage();
  return (user + system) * 1e-6;
};
const tilt = (world, brick) => Math.acos(Math.min(1, Math.max(-1, world.upright(brick))));

function follow(world, scene, rate, window, limit) {
  const count = scene.bricks.length;
  const arrivals = [];
  let [added, removed, lastTilt, last] = [0, 0, 0, 0];
  const addUpTo = (end) => {
    while (added < Math.min(count, end)) world.add(added++);
  };
  addUpTo(window === 0 ? count : kAhead);
  const { heading } = scene.bricks[0];
  const speed = kPush / (scene.timeStep * rate);
  const ahead = 0.5 * speed * scene.height;
  world.setVelocity(
    0,
    [ahead * Math.cos(heading), ahead * Math.sin(heading), 0.5 * speed * scene.thickness],
    [-speed * Math.sin(heading), speed * Math.cos(heading), 0],
  );
  const begin = cpuNow();
  for (let step = 1; ; ++step) {
    world.step();
    const time = step / rate;
    while (arrivals.length < count) {
      const now = tilt(world, arrivals.length);
      if (now < kArrivalTilt) {
        lastTilt = now;
        break;
      }
      const share = now > lastTilt ? (now - kArrivalTilt) / (now - lastTilt) : 0;
      arrivals.push(time - share / rate);
      lastTilt = 0;
      last = time;
      if (window === 0) continue;
      addUpTo(arrivals.length + kAhead);
      while (removed + window < arrivals.length) world.remove(removed++);
    }
    const cut = cpuNow() - begin > limit;
    if (cut || time > last + (arrivals.length === count ? kAfter : 2)) return { arrivals, cut };
  }
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

/** `make(scene)` gives a world with add, remove, setVelocity, step and upright; `scale` is lengths in the engine over true lengths. */
export function run({ name, version, scale, make }) {
  const [path, rateWord, windowWord, limitWord] = process.argv.slice(2);
  const rate = Number(rateWord);
  const scene = readScene(path, scale, rate);
  const begin = cpuNow();
  const { arrivals, cut } = follow(make(scene), scene, rate, Number(windowWord), Number(limitWord));
  const cpu = cpuNow() - begin;
  const count = scene.bricks.length;
  // Of those that were reached, since a run may be cut.
  const from = Math.floor(arrivals.length / 5);
  const to = Math.floor((arrivals.length * 4) / 5);
  const speed = to > from ? pathLength(scene, from, to) / scale / (arrivals[to] - arrivals[from]) : 0;
  const result = { engine: name, version, bricks: count, arrived: arrivals.length, cpu_s: cpu, front_speed_m_s: speed, cut, hash: hashOf(arrivals) };
  console.log(JSON.stringify(result));
  process.exit(0);
}
