/** The table: a sheet without an end that melts into the background, like a photographer's sweep. */

import { CircleGeometry, Color, Fog, Mesh, MeshStandardMaterial, type Scene } from 'three';

/** Linear-light colours that come out as the design's table and background after tone mapping. */
export const kTableColors = {
  light: { table: 0xc6bcb0, background: 0xcbc5bd },
  dark: { table: 0x3b3f47, background: 0x24272d },
};

export class Table {
  readonly mesh: Mesh;
  private readonly material = new MeshStandardMaterial({ roughness: 0.93, metalness: 0 });
  private readonly fog = new Fog(0, 1, 10);
  private readonly background = new Color();

  constructor(scene: Scene) {
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

  /** @param distance From the camera to what it looks at [m]. @param extent Of all bricks [m]. */
  fit(x: number, y: number, distance: number, extent: number): void {
    const size = 40 * (distance + extent);
    this.mesh.position.set(x, y, 0);
    this.mesh.scale.set(size, size, 1);
    this.fog.near = distance;
    this.fog.far = Math.max(3.2 * distance, distance + 1.5 * extent);
  }
}
