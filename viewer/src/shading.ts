// SPDX-License-Identifier: Apache-2.0
// The light of a mix, summed per vertex on the graphics card, and its looks: picture, false
// colours, normals, reflectance.

import * as THREE from 'three'
import { FALSE_COLOUR_GLSL } from './false_colour'
import type { Material, Pattern } from './solution'
import { TONE_GLSL } from './tone'

export type Look = 'picture' | 'illuminance' | 'exitance' | 'normals' | 'reflectance' | 'unshot'
export const LOOKS: Look[] = ['picture', 'illuminance', 'exitance', 'normals', 'reflectance', 'unshot']

/** Shared by all materials, so that setting a value shows everywhere. */
export interface LookUniforms {
  factors: { value: Float32Array }     // RGB per column
  restFactors: { value: THREE.DataTexture } // RGB per group that is no column
  groupFactors: { value: Float32Array } // RGB per group, for what shines itself
  look: { value: number }
  raw: { value: boolean }              // linear radiance and coverage, for measuring
  exposure: { value: number }
  toneCurve: { value: number }
  white: { value: number }
  range: { value: THREE.Vector2 }      // of the false colours
  contour: { value: number }           // step of the contours, 0 = none
  section: { value: THREE.Vector4 }    // shown where dot(xyz, p) <= w; 0 = everywhere
  [name: string]: THREE.IUniform
}

/** RGBA in full precision, looked up texel by texel. */
export function floatTexture(width: number, height: number): THREE.DataTexture {
  const out = new THREE.DataTexture(new Float32Array(4 * width * height), width, height, THREE.RGBAFormat, THREE.FloatType)
  out.needsUpdate = true
  return out
}

export const REST_WIDTH = 4096

export function lookUniforms(columns: number, groups: number): LookUniforms {
  return {
    factors: { value: new Float32Array(3 * columns) },
    restFactors: { value: floatTexture(Math.max(1, groups - columns), 1) },
    groupFactors: { value: new Float32Array(3 * groups) },
    look: { value: 0 }, raw: { value: false }, exposure: { value: 1 }, toneCurve: { value: 1 },
    white: { value: 4 }, range: { value: new THREE.Vector2(0, 1) }, contour: { value: 0 },
    section: { value: new THREE.Vector4(0, 0, 0, 0) },
  }
}

const list = <T>(n: number, each: (k: number) => T) => Array.from({ length: n }, (_, k) => each(k))

/** Columns are exitance, or irradiance where a pattern makes exitance vary within a triangle. The
 * light of groups that are no columns, `rest`, is looked up in a texture by the vertex's number. */
function vertexShader(columns: number, rest: number, patterned: boolean): string {
  return /* glsl */ `
precision highp float;
precision highp int;
precision highp sampler2D;
${rest > 0 ? 'uniform sampler2D restLight, restFactors;\nuniform int vertices;' : ''}
uniform mat4 modelMatrix, viewMatrix, projectionMatrix;
uniform vec3 factors[${columns}];
in vec3 position, normal;
${patterned ? 'in vec2 uv0, uv1;\nout vec2 place0, place1;' : ''}
${list(columns, (k) => `in vec3 column${k};`).join('\n')}
out vec3 light, facing, where;
#ifdef RIM
uniform vec3 cameraPosition;
out float towards;
#endif
void main() {
  light = ${list(columns, (k) => `factors[${k}] * column${k}`).join(' + ')};
  ${rest > 0 ? `for (int k = 0; k < ${rest}; ++k) {
    int i = k * vertices + gl_VertexID;
    light += texelFetch(restFactors, ivec2(k, 0), 0).rgb * texelFetch(restLight, ivec2(i % ${REST_WIDTH}, i / ${REST_WIDTH}), 0).rgb;
  }` : ''}
  facing = normal;
  ${patterned ? 'place0 = uv0; place1 = uv1;' : ''}
  vec4 world = modelMatrix * vec4(position, 1.0);
  where = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
#ifdef RIM
  // At the end of what is seen: only where nothing else is.
  towards = dot(mat3(modelMatrix) * normal, cameraPosition - where);
  gl_Position.z = (1.0 - 1e-5) * gl_Position.w + 5e-6 * gl_Position.z;
#endif
}`
}

function fragmentShader(patterned: boolean): string {
  return /* glsl */ `
precision highp float;
uniform int look;
uniform bool raw, isIrradiance;
uniform float exposure, contour;
uniform vec2 range;
uniform vec4 section;
uniform vec3 reflectance, emission, emissionFactor;
${patterned ? `
uniform sampler2D reflectanceMap, emissionMap;
uniform vec3 reflectanceTexel, emissionTexel;
uniform vec2 most;
in vec2 place0, place1;` : ''}
in vec3 light, facing, where;
#ifdef RIM
in float towards;
#endif
out vec4 colour;
${TONE_GLSL}
${FALSE_COLOUR_GLSL}
void main() {
  if (dot(section.xyz, where) > section.w && section.xyz != vec3(0.0)) discard;
#ifdef RIM
  if (towards <= 0.0) discard;
#endif
  vec3 rho = reflectance, E = emission;
  ${patterned ? `
  if (reflectanceTexel.r >= 0.0)
    rho = reflectanceTexel * min(texture(reflectanceMap, place0).rgb, most.x);
  if (emissionTexel.r >= 0.0)
    E = emissionTexel * min(texture(emissionMap, place1).rgb, most.y);` : ''}
  vec3 B = isIrradiance ? E * emissionFactor + rho * light : light;
  if (raw) { colour = vec4(B / 3.14159265359, 1.0); return; }
  // Contours are of what is received, where that is what the columns are.
  float value = dot(isIrradiance && look != 2 ? light : B, LUMINANCE);
  vec3 shown;
  if (look == 1 || look == 2 || look == 5) {
    shown = falseColour((value - range.x) / max(range.y - range.x, 1e-30));
  } else if (look == 3) {
    shown = 0.5 + 0.5 * normalize(facing);
  } else if (look == 4) {
    shown = rho;
  } else {
    shown = toned(exposure * B / 3.14159265359);
  }
  if (contour > 0.0) {
    float level = value / contour, width = fwidth(level);
    float away = abs(fract(level - 0.5) - 0.5) / max(width, 1e-6);
    float line = (1.0 - smoothstep(0.6, 1.4, away)) * step(0.5, level) * (1.0 - smoothstep(0.3, 0.6, width));
    shown = mix(shown, dot(shown, LUMINANCE) > 0.2 ? vec3(0.0) : vec3(0.9), 0.85 * line);
  }
  colour = vec4(look == 3 ? shown : encoded(shown), 1.0);
}`
}

function mapUniforms(pattern: Pattern | undefined, textures: THREE.Texture[]) {
  return { map: pattern ? textures[pattern.texture] : null,
    texel: new THREE.Vector3(...(pattern?.factor ?? [-1, -1, -1])), most: pattern?.most ?? 1 }
}

/** What a geometry's columns hold, and the light of the groups beyond them. */
export interface Columns {
  are: 'exitance' | 'irradiance'
  count: number
  rest: number                // groups
  restLight?: THREE.DataTexture
  vertices: number
}

/** The material of one primitive. */
export function surfaceMaterial(columns: Columns, material: Material, group: number, textures: THREE.Texture[], shared: LookUniforms): THREE.RawShaderMaterial {
  const patterned = columns.are === 'irradiance' && !!(material.reflectancePattern || material.exitancePattern)
  const r = mapUniforms(material.reflectancePattern, textures), e = mapUniforms(material.exitancePattern, textures)
  // The factor of the group that the surface shines in follows the mix: a view of the same array.
  const emissionFactor = { get value() { return new THREE.Vector3().fromArray(shared.groupFactors.value, 3 * group) } }
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: vertexShader(columns.count, columns.rest, patterned),
    fragmentShader: fragmentShader(patterned),
    uniforms: {
      ...shared,
      isIrradiance: { value: columns.are === 'irradiance' },
      ...(columns.restLight ? { restLight: { value: columns.restLight }, vertices: { value: columns.vertices } } : {}),
      reflectance: { value: new THREE.Vector3(...material.reflectance) },
      emission: { value: new THREE.Vector3(...material.exitance) },
      emissionFactor,
      ...(patterned ? {
        reflectanceMap: { value: r.map ?? e.map }, emissionMap: { value: e.map ?? r.map },
        reflectanceTexel: { value: r.texel }, emissionTexel: { value: e.texel },
        most: { value: new THREE.Vector2(r.most, e.most) },
      } : {}),
    },
    side: THREE.FrontSide,
  })
}
