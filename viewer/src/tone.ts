// SPDX-License-Identifier: Apache-2.0
// From radiance to what a screen can show: the operators of `exitance render`
// (src/exitance/render/tone.cpp), for the shader and for numbers.

export type ToneCurve = 'linear' | 'reinhard' | 'filmic'
export const TONE_CURVES: ToneCurve[] = ['linear', 'reinhard', 'filmic']

/** Rec. 709 luminance of linear RGB. */
export function luminance(r: number, g: number, b: number): number {
  return 0.2126 * r + 0.7152 * g + 0.0722 * b
}

/** Makes luminance 1.2 * 2^EV one (Lagarde & de Rousiers 2014, section 5.1.2). */
export function exposureOfEv(ev: number): number {
  return 1 / (1.2 * 2 ** ev)
}
export function evOfExposure(exposure: number): number {
  return Math.log2(1 / (1.2 * exposure))
}

/** Brings the logarithmic average of the luminances to 0.18 (Reinhard et al. 2002, eqs. 1 and 2);
 * darkness counts as 1/1000 of the 99th percentile. `pixels`: RGB radiance and coverage. */
export function automaticExposure(pixels: Float32Array): number {
  const seen: number[] = []
  for (let i = 0; i < pixels.length; i += 4)
    if (pixels[i + 3] > 0.5) seen.push(luminance(pixels[i], pixels[i + 1], pixels[i + 2]) / pixels[i + 3])
  if (seen.length === 0) return 1
  seen.sort((a, b) => a - b)
  const high = seen[Math.floor(seen.length * 99 / 100)], brightest = seen[seen.length - 1]
  const darkest = 1e-3 * (high > 0 ? high : brightest)
  if (!(darkest > 0)) return 1
  let sum = 0
  for (const value of seen) sum += Math.log(Math.max(value, darkest))
  return 0.18 / Math.exp(sum / seen.length)
}

/** The luminance that Reinhard's curve makes white: the brightest, but at most 4. */
export function whiteOf(pixels: Float32Array, exposure: number): number {
  let brightest = 0
  for (let i = 0; i < pixels.length; i += 4)
    brightest = Math.max(brightest, exposure * luminance(pixels[i], pixels[i + 1], pixels[i + 2]))
  return Math.min(4, Math.max(1, brightest))
}

export const TONE_GLSL = /* glsl */ `
uniform int toneCurve;  // 0 linear, 1 Reinhard et al. 2002 eq. 4, 2 Narkowicz 2015
uniform float white;
const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);
vec3 toned(vec3 c) {
  if (toneCurve == 1) {
    float L = dot(c, LUMINANCE);
    c *= (1.0 + L / (white * white)) / (1.0 + L);
  } else if (toneCurve == 2) {
    c = c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14);
  }
  return clamp(c, 0.0, 1.0);
}
// IEC 61966-2-1
vec3 encoded(vec3 c) {
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}
`
