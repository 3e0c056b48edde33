/** Full-screen passes: averaging frames, and from linear light to the screen (tone, a slight vignette, sRGB, dither). */

import { GLSL3, Mesh, OrthographicCamera, PlaneGeometry, RawShaderMaterial, Scene, type Texture, type WebGLRenderer, type WebGLRenderTarget } from 'three';

const kVertex = /* glsl */ `
  in vec3 position;
  out vec2 at;
  void main() { at = 0.5 * position.xy + 0.5; gl_Position = vec4(position.xy, 0.0, 1.0); }
`;

const kAverage = /* glsl */ `
  precision highp float;
  in vec2 at;
  out vec4 color;
  uniform sampler2D before;
  uniform sampler2D frame;
  uniform float weight;
  void main() { color = mix(texture(before, at), texture(frame, at), weight); }
`;

const kScreen = /* glsl */ `
  precision highp float;
  in vec2 at;
  out vec4 color;
  uniform sampler2D live;
  uniform sampler2D still;
  uniform float share;
  uniform float exposure;

  // The fit of the ACES reference transforms by Stephen Hill.
  vec3 aces(vec3 c) {
    const mat3 into = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
    const mat3 back = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    vec3 v = into * c;
    v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return clamp(back * v, 0.0, 1.0);
  }
  float noise(vec2 p) { return fract(52.9829189 * fract(dot(p, vec2(0.06711056, 0.00583715)))); }

  void main() {
    vec3 light = mix(texture(live, at).rgb, texture(still, at).rgb, share);
    vec2 off = at - 0.5;
    light *= exposure * (1.0 - 0.42 * dot(off, off));
    vec3 c = aces(light);
    c = mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, vec3(lessThanEqual(c, vec3(0.0031308))));
    color = vec4(c + (noise(gl_FragCoord.xy) - 0.5) / 255.0, 1.0);
  }
`;

export class FinalPass {
  private readonly quad = new Mesh(new PlaneGeometry(2, 2));
  private readonly scene = new Scene();
  private readonly camera = new OrthographicCamera();
  private readonly average: RawShaderMaterial;
  private readonly screen: RawShaderMaterial;

  constructor(private readonly renderer: WebGLRenderer) {
    const material = (fragmentShader: string, names: string[]): RawShaderMaterial =>
      new RawShaderMaterial({
        glslVersion: GLSL3,
        vertexShader: kVertex,
        fragmentShader,
        depthTest: false,
        depthWrite: false,
        uniforms: Object.fromEntries(names.map((name) => [name, { value: null }])),
      });
    this.average = material(kAverage, ['before', 'frame', 'weight']);
    this.screen = material(kScreen, ['live', 'still', 'share', 'exposure']);
    this.quad.frustumCulled = false;
    this.scene.add(this.quad);
  }

  /** Asks for the programs, without waiting for them. */
  compile(): void {
    for (const material of [this.screen, this.average]) {
      this.quad.material = material;
      this.renderer.setRenderTarget(null);
      this.renderer.compile(this.scene, this.camera);
    }
  }

  private draw(material: RawShaderMaterial, target: WebGLRenderTarget | null): void {
    this.quad.material = material;
    this.renderer.setRenderTarget(target);
    this.renderer.render(this.scene, this.camera);
  }

  /** into = before + weight (frame - before) */
  blend(before: Texture, frame: Texture, weight: number, into: WebGLRenderTarget): void {
    this.average.uniforms.before.value = before;
    this.average.uniforms.frame.value = frame;
    this.average.uniforms.weight.value = weight;
    this.draw(this.average, into);
  }

  /** @param share How much of the averaged still is shown, the rest being the live frame; 0 to 1. */
  show(live: Texture, still: Texture, share: number, exposure: number): void {
    this.screen.uniforms.live.value = live;
    this.screen.uniforms.still.value = still;
    this.screen.uniforms.share.value = share;
    this.screen.uniforms.exposure.value = exposure;
    this.draw(this.screen, null);
  }
}
