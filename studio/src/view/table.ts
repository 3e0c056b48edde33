/** The table: a sheet without an end that melts into the background, like a photographer's sweep. */

import { CircleGeometry, Color, Fog, Mesh, MeshStandardMaterial, Vector2, type Scene } from 'three';

/** Linear-light colours that come out as the design's table and background after tone mapping. */
export const kTableColors = {
  light: { table: 0xc6bcb0, background: 0xcbc5bd },
  dark: { table: 0x3b3f47, background: 0x24272d },
};

const kGrid = /* glsl */ `
  varying vec2 vPlace;
  uniform float gridStrength;
  uniform vec2 gridOrigin;
  // 1 on a line of a grid of so many metres, less where its lines would run together.
  float gridLine(float size) {
    vec2 cell = (vPlace + gridOrigin) / size;
    vec2 grain = max(fwidth(cell), vec2(1e-6));
    vec2 away = abs(fract(cell - 0.5) - 0.5) / grain;
    vec2 line = (1.0 - smoothstep(0.4, 1.2, away)) * (1.0 - smoothstep(0.06, 0.25, grain));
    return max(line.x, line.y);
  }
`;

export class Table {
  readonly mesh: Mesh;
  private readonly material = new MeshStandardMaterial({ roughness: 0.93, metalness: 0 });
  private readonly fog = new Fog(0, 1, 10);
  private readonly background = new Color();
  /** Lines of 100 mm and of a metre, faint, for drawing: how strong, and where the layout's own origin is. */
  private readonly grid = { strength: { value: 0 }, origin: { value: new Vector2() } };

  constructor(scene: Scene) {
    this.material.onBeforeCompile = (shader) => {
      shader.uniforms.gridStrength = this.grid.strength;
      shader.uniforms.gridOrigin = this.grid.origin;
      shader.vertexShader = shader.vertexShader
        .replace('#include <common>', '#include <common>\nvarying vec2 vPlace;')
        .replace('#include <begin_vertex>', '#include <begin_vertex>\nvPlace = (modelMatrix * vec4(position, 1.0)).xy;');
      shader.fragmentShader = shader.fragmentShader
        .replace('#include <common>', `#include <common>\n${kGrid}`)
        .replace('#include <color_fragment>', 'diffuseColor.rgb *= 1.0 - gridStrength * max(gridLine(0.1), 1.6 * gridLine(1.0));');
    };
    this.mesh = new Mesh(new CircleGeometry(1, 64), this.material);
    this.mesh.receiveShadow = true;
    this.mesh.frustumCulled = false;
    scene.add(this.mesh);
    scene.fog = this.fog;
    scene.background = this.background;
  }

  setTheme(theme: 'light' | 'dark'): void {
    this.material.color.set(kTableColors[theme].table);
    this.background.set(kTableColors[theme].background);
    this.fog.color.set(kTableColors[theme].background);
  }

  /** @param origin Of the view, in the layout's axes [m]. */
  showGrid(shown: boolean, origin: readonly number[]): void {
    this.grid.strength.value = shown ? 0.07 : 0;
    this.grid.origin.value.set(origin[0] % 1, origin[1] % 1);
  }

  /** @param distance From the camera to what it looks at [m]. @param extent Of all bricks [m]. */
  fit(x: number, y: number, distance: number, extent: number): void {
    const size = 40 * (distance + extent);
    this.mesh.position.set(x, y, 0);
    this.mesh.scale.set(size, size, 1);
    this.fog.near = distance;
    this.fog.far = Math.max(3.2 * distance, distance + 1.5 * extent);
  }
}
