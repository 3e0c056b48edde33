/**
 * The shape that every brick shares: a box with rounded edges, without a size. `position` holds which corner a vertex belongs to
 * (each part -1 or 1), `normal` the way its rounding points; the vertex shader adds size and radius, so one draw serves all kinds.
 */

import { BufferAttribute, InstancedBufferGeometry } from 'three';

/** Steps round an edge by how many bricks are drawn: near 600 triangles a brick, 100, or a plain box of 12. */
export function roundingFor(bricks: number): number {
  return bricks <= 3000 ? 3 : bricks <= 30000 ? 1 : 0;
}

export function brickGeometry(steps: number): InstancedBufferGeometry {
  const corners: number[] = [];
  const normals: number[] = [];
  const indices: number[] = [];
  for (let axis = 0; axis < 3; axis++) {
    for (const side of [-1, 1]) addFace(axis, side, steps, corners, normals, indices);
  }
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(Float32Array.from(corners), 3));
  geometry.setAttribute('normal', new BufferAttribute(Float32Array.from(normals), 3));
  geometry.setIndex(indices);
  return geometry;
}

/** Along one edge of a face: which corner, and the slope of the rounding there (0 on the flat, 1 at 45 degrees). */
function stops(steps: number): { corner: number; slope: number }[] {
  if (steps === 0) return [-1, 1].map((corner) => ({ corner, slope: 0 }));
  const out = [];
  for (let i = 0; i <= steps; i++) out.push({ corner: -1, slope: -Math.tan((Math.PI / 4) * (1 - i / steps)) });
  for (let i = 0; i <= steps; i++) out.push({ corner: 1, slope: Math.tan((Math.PI / 4) * (i / steps)) });
  return out;
}

function addFace(axis: number, side: number, steps: number, corners: number[], normals: number[], indices: number[]): void {
  const line = stops(steps);
  const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
  const first = corners.length / 3;
  for (const b of line) {
    for (const a of line) {
      const corner = [0, 0, 0];
      const normal = [0, 0, 0];
      corner[axis] = side;
      corner[u] = a.corner;
      corner[v] = b.corner;
      const length = Math.hypot(1, a.slope, b.slope);
      normal[axis] = side / length;
      normal[u] = a.slope / length;
      normal[v] = b.slope / length;
      corners.push(...corner);
      normals.push(...normal);
    }
  }
  const n = line.length;
  for (let j = 0; j + 1 < n; j++) {
    for (let i = 0; i + 1 < n; i++) {
      const p = first + j * n + i;
      const quad = [p, p + 1, p + n + 1, p, p + n + 1, p + n];
      indices.push(...(side > 0 ? quad : quad.reverse()));
    }
  }
}
