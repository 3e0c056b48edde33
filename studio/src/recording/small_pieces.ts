/** The pieces that come once: recipe, scene, energy, end. */

import type { Payload } from './payload.ts';
import type { Energy, Kind, Part, Push, Recipe, Recording, RunEnd } from './types.ts';

export type Scene = Pick<Recording, 'title' | 'gravity' | 'kinds' | 'colors' | 'parts' | 'pushes'>;

export function readRecipe(piece: Payload): Recipe {
  const version = piece.string('the version');
  const model = piece.string('the model');
  const layoutName = piece.string('the name of the layout');
  const layoutText = piece.string('the layout');
  const timeStep = piece.finite('the time step');
  const count = piece.count('overrides', 4);
  const overrides = Array.from({ length: count }, () => piece.string('an override'));
  return { version, model, layoutName, layoutText, timeStep, overrides };
}

export function readScene(piece: Payload): Scene {
  const title = piece.string('the title');
  const gravity = piece.finite('gravity');
  piece.finite('the tolerance');
  const kinds = Array.from({ length: piece.count('kinds', 71) }, () => readKind(piece));
  const colors = Array.from({ length: piece.count('colours', 3) }, () => piece.color('a colour'));
  const parts = Array.from({ length: piece.count('parts', 12) }, () => readPart(piece));
  const pushes = Array.from({ length: piece.count('pushes', 37) }, () => readPush(piece));
  return { title, gravity, kinds, colors, parts, pushes };
}

function readKind(piece: Payload): Kind {
  const name = piece.string('the name of a kind');
  const [height, width, thickness, mass] = ['height', 'width', 'thickness', 'mass'].map((what) => {
    const value = piece.finite(`the ${what} of ${name}`);
    return value > 0 ? value : piece.fail(`the ${what} of ${name} is ${value}, it must be over 0`);
  });
  for (const what of ['brick friction', 'floor friction', 'brick restitution', 'floor restitution']) piece.finite(what);
  return { name, height, width, thickness, mass, color: piece.color(`the colour of ${name}`), ball: false };
}

/** Says of the kinds that are already there which are balls. */
export function readShapes(piece: Payload, kinds: Kind[]): void {
  const count = piece.count('shapes', 1);
  if (count !== kinds.length) piece.fail(`${count} shapes of ${kinds.length} kinds`);
  piece.u8s(count, 'shapes').forEach((shape, i) => (kinds[i].ball = shape === 1));
}

function readPart(piece: Payload): Part {
  return { name: piece.string('the name of a part'), first: piece.u32('its first brick'), count: piece.u32('its bricks') };
}

function readPush(piece: Payload): Push {
  const brick = piece.u32('the pushed brick');
  const at = piece.finite('the time of a push');
  const way = piece.u8('the way of a push');
  if (way > 2) piece.fail(`a push of way ${way}, which is not known`);
  return { brick, at, way, value: piece.f64('a push'), height: piece.f64('its height'), duration: piece.f64('its duration') };
}

export function readEnergy(piece: Payload): Energy {
  const count = piece.count('energies', 32);
  piece.u32('zero');
  return {
    time: piece.f64s(count, 'times'),
    kinetic: piece.f64s(count, 'kinetic energies'),
    potential: piece.f64s(count, 'potential energies'),
    pushWork: piece.f64s(count, 'push work'),
  };
}

export function readEnd(piece: Payload): RunEnd {
  return {
    reason: piece.u32('the reason'),
    brick: piece.u32('the brick'),
    steps: Number(piece.u64('the steps')),
    time: piece.finite('the time of the end'),
    hash: piece.u64('the hash').toString(16).padStart(16, '0'),
    words: piece.string('the words'),
  };
}
