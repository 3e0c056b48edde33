/** The surface of the bricks: placed, sized and coloured by instance; pips drawn by distance, so that they are crisp at any zoom. */

import { MeshDepthMaterial, MeshStandardMaterial, RGBADepthPacking, type WebGLProgramParametersWithUniforms } from 'three';

/** Radius of a brick's edges [m]; less for bricks that are thin against it. */
const kEdge = 0.0011;

const kPlace = /* glsl */ `
  attribute vec3 iPosition;
  attribute vec4 iTurn;
  attribute vec3 iHalf;
  attribute vec4 iColor;
  vec3 turned(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
  vec3 localPoint() {
    vec3 size = abs(iHalf);
    // A ball is all rounding.
    float edge = iHalf.x < 0.0 ? size.x : min(${kEdge.toFixed(5)}, 0.3 * min(size.x, min(size.y, size.z)));
    return position * (size - edge) + normal * edge;
  }
`;

const kVertexVaryings = /* glsl */ `
  varying vec3 vLocal;
  varying vec3 vFacing;
  flat varying vec3 vHalf;
  flat varying vec4 vPaint;
  flat varying vec3 vAcross;
  flat varying vec3 vUp;
`;

const kPips = /* glsl */ `
  varying vec3 vLocal;
  varying vec3 vFacing;
  flat varying vec3 vHalf;
  flat varying vec4 vPaint;
  flat varying vec3 vAcross;
  flat varying vec3 vUp;

  uniform float surroundings;

  // What a brick mirrors towards r (world axes), and how much of it (Schlick's Fresnel term for plastic).
  vec3 mirrored(vec3 r, float facing) {
    float fresnel = 0.035 + 0.42 * pow(1.0 - facing, 5.0);
    float box = smoothstep(0.55, 0.95, dot(r, vec3(-0.25, 0.2, 0.947)));
    vec3 light = mix(vec3(0.30, 0.27, 0.24), vec3(0.62, 0.68, 0.78), smoothstep(-0.15, 0.45, r.z)) + 1.2 * box;
    return fresnel * surroundings * light;
  }

  vec3 linearFromSrgb(vec3 c) {
    return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, vec3(lessThanEqual(c, vec3(0.04045))));
  }

  // From p to the middle of the nearest of n pips, which sit on a 3 x 3 grid with spacing a.
  vec2 fromPip(vec2 p, int n, float a) {
    vec2 best = vec2(1.0);
    vec2 q;
    if (n % 2 == 1 && dot(p, p) < dot(best, best)) best = p;
    if (n >= 2) {
      q = p - (p.x + p.y > 0.0 ? vec2(a) : vec2(-a));
      if (dot(q, q) < dot(best, best)) best = q;
    }
    if (n >= 4) {
      q = p - (p.x - p.y > 0.0 ? vec2(a, -a) : vec2(-a, a));
      if (dot(q, q) < dot(best, best)) best = q;
    }
    if (n == 6) {
      q = p - vec2(p.x > 0.0 ? a : -a, 0.0);
      if (dot(q, q) < dot(best, best)) best = q;
    }
    return best;
  }

  // Ink (0 to 1) in x, line (0 to 1) in y, and the slope of the dent in zw.
  vec4 pipsAt(vec2 p, vec2 halfFace, float number, vec2 grain) {
    int lower = int(mod(number, 7.0));
    int upper = int(floor(number / 7.0));
    float cell = min(2.0 * halfFace.x, halfFace.y);
    float radius = 0.088 * cell;
    int n = p.y > 0.0 ? upper : lower;
    vec2 middle = vec2(0.0, (p.y > 0.0 ? 0.5 : -0.5) * halfFace.y);
    float blur = max(length(grain), 1e-7);
    vec2 d = fromPip(p - middle, n, 0.27 * cell);
    float away = length(d);
    float ink = 1.0 - smoothstep(radius - 0.6 * blur, radius + 0.6 * blur, away);
    float share = float(n) * 3.1416 * radius * radius / (2.0 * halfFace.x * halfFace.y);
    ink = mix(ink, share, smoothstep(0.9 * radius, 3.0 * radius, blur));
    float width = 0.011 * cell;
    float line = (1.0 - smoothstep(width - 0.5 * blur, width + 0.5 * blur, abs(p.y)))
      * (1.0 - smoothstep(0.0, 0.6 * blur + 1e-5, abs(p.x) - 0.8 * halfFace.x)) * min(1.0, 2.0 * width / blur);
    float dent = ink * smoothstep(0.0, radius, away) * (1.0 - smoothstep(0.4 * radius, radius, blur));
    return vec4(ink, line, -0.55 * dent * d / max(away, 1e-7));
  }
`;

const kTransformed = 'vec3 transformed = iPosition + turned(iTurn, localPoint());';

function placeVertices(shader: WebGLProgramParametersWithUniforms): void {
  shader.vertexShader = shader.vertexShader
    .replace('#include <common>', `#include <common>\n${kPlace}`)
    .replace('#include <begin_vertex>', kTransformed);
}

/**
 * @param surroundings How bright the studio is that the bricks mirror: a soft box overhead and a pale table below. It is a few sums
 *   rather than a picture of a room, whose filtering takes seconds where there is no graphics card.
 */
export function brickMaterial(surroundings: { value: number }): MeshStandardMaterial {
  const material = new MeshStandardMaterial({ roughness: 0.36, metalness: 0, fog: false });
  material.onBeforeCompile = (shader) => {
    placeVertices(shader);
    shader.uniforms.surroundings = surroundings;
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', `#include <common>\n${kVertexVaryings}`)
      .replace('#include <beginnormal_vertex>', 'vec3 objectNormal = turned(iTurn, normal);');
    shader.vertexShader = shader.vertexShader.replace(
      kTransformed,
      /* glsl */ `${kTransformed}
        vLocal = localPoint(); vFacing = normal; vHalf = iHalf; vPaint = iColor;
        vAcross = normalMatrix * turned(iTurn, vec3(0.0, 1.0, 0.0)); vUp = normalMatrix * turned(iTurn, vec3(0.0, 0.0, 1.0));`,
    );
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', `#include <common>\n${kPips}`)
      .replace(
        '#include <color_fragment>',
        /* glsl */ `
        vec2 facePoint = vLocal.yz;
        vec2 grain = vec2(length(vec2(dFdx(facePoint.x), dFdy(facePoint.x))), length(vec2(dFdx(facePoint.y), dFdy(facePoint.y))));
        vec4 pips = pipsAt(facePoint, vHalf.yz, floor(vPaint.a * 255.0 + 0.5), grain);
        pips *= smoothstep(0.9, 0.98, abs(vFacing.x)) * step(0.0, vHalf.x);
        vec3 paint = linearFromSrgb(vPaint.rgb);
        float lightness = dot(paint, vec3(0.2126, 0.7152, 0.0722));
        vec3 ink = lightness > 0.42 ? vec3(0.018, 0.017, 0.016) : vec3(0.82, 0.79, 0.72);
        diffuseColor.rgb = mix(paint, ink, pips.x);
        diffuseColor.rgb = mix(diffuseColor.rgb, paint * 0.12, 0.85 * pips.y * (1.0 - pips.x));`,
      )
      .replace(
        '#include <normal_fragment_maps>',
        '#include <normal_fragment_maps>\nnormal = normalize(normal + pips.z * vAcross + pips.w * vUp);',
      )
      .replace(
        '#include <opaque_fragment>',
        /* glsl */ `
        vec3 towards = normalize(vViewPosition);
        vec3 around = inverseTransformDirection(reflect(-towards, normal), viewMatrix);
        outgoingLight += mirrored(around, clamp(dot(towards, normal), 0.0, 1.0));
        #include <opaque_fragment>`,
      );
  };
  return material;
}

/** What the sun's shadow map sees of the bricks. */
export function brickDepthMaterial(): MeshDepthMaterial {
  const material = new MeshDepthMaterial({ depthPacking: RGBADepthPacking });
  material.onBeforeCompile = placeVertices;
  return material;
}
