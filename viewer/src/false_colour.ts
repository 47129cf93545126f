// SPDX-License-Identifier: Apache-2.0
// Quantities as colours, and the marks that tell them back: the colours of
// src/exitance/render/false_colour.cpp, whose lightness rises evenly in Oklab (Ottosson 2020).

const cube = (v: number) => v * v * v
const clamp01 = (v: number) => Math.min(1, Math.max(0, v))

/** Linear RGB for t in 0 ... 1. */
export function falseColour(t: number): [number, number, number] {
  t = clamp01(t)
  const L = 0.25 + 0.68 * t
  const hue = (300 - 195 * t) * Math.PI / 180
  const chroma = 0.094 + 0.2 * (t - 0.42) * (t - 0.42)
  const a = chroma * Math.cos(hue), b = chroma * Math.sin(hue)
  const l = cube(L + 0.3963377774 * a + 0.2158037573 * b)
  const m = cube(L - 0.1055613458 * a - 0.0638541728 * b)
  const s = cube(L - 0.0894841775 * a - 1.2914855480 * b)
  return [4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s]
}

/** The same in a shader. */
export const FALSE_COLOUR_GLSL = /* glsl */ `
vec3 falseColour(float t) {
  t = clamp(t, 0.0, 1.0);
  float hue = radians(300.0 - 195.0 * t);
  float chroma = 0.094 + 0.2 * (t - 0.42) * (t - 0.42);
  float L = 0.25 + 0.68 * t, a = chroma * cos(hue), b = chroma * sin(hue);
  vec3 r = vec3(L) + mat3(0.3963377774, -0.1055613458, -0.0894841775,
    0.2158037573, -0.0638541728, -1.2914855480, 0.0, 0.0, 0.0) * vec3(a, b, 0.0);
  r = r * r * r;
  return clamp(mat3(4.0767416621, -1.2684380046, -0.0041960863,
    -3.3077115913, 2.6097574011, -0.7034186147,
    0.2309699292, -0.3413193965, 1.7076147010) * r, 0.0, 1.0);
}
`

/** sRGB bytes as CSS takes them. */
export function cssColour(linear: readonly number[]): string {
  const byte = (v: number) => {
    v = clamp01(v)
    return Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055))
  }
  return `rgb(${byte(linear[0])} ${byte(linear[1])} ${byte(linear[2])})`
}

export function roundStep(span: number, count: number): number {
  const raw = span / Math.max(1, count)
  const power = 10 ** Math.floor(Math.log10(raw))
  for (const factor of [1, 2, 5]) if (factor * power >= raw * 0.999) return factor * power
  return 10 * power
}

/** Round values from `low` to `high`, about `count` of them. */
export function roundMarks(low: number, high: number, count: number): number[] {
  if (!(high > low)) return [low]
  const step = roundStep(high - low, count)
  const marks = []
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) marks.push(k * step + 0)  // + 0: no -0
  return marks
}
