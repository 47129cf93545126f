// SPDX-License-Identifier: Apache-2.0
// The mix of lights as it is shown now, as a binary glTF with vertex colours that any viewer opens.

import { luminance } from './tone'
import type { Viewer } from './viewer'

const pad = (n: number) => (n + 3) & ~3

/** Tone mapped as Reinhard et al. 2002, eq. 4, at the page's exposure: linear values 0 ... 1. */
function colours(viewer: Viewer): Uint16Array {
  const { solution } = viewer, factors = viewer.mix.factors(performance.now())
  const exposure = viewer.stage.uniforms.exposure.value / Math.PI, white = viewer.stage.uniforms.white.value
  const vertices = solution.positions.length / 3, out = new Uint16Array(4 * vertices)
  for (let v = 0; v < vertices; ++v) {
    const B = [0, 1, 2].map((c) => solution.exitance.reduce((sum, of, g) => sum + factors[3 * g + c] * of[3 * v + c], 0) * exposure)
    const L = luminance(B[0], B[1], B[2]), scale = (1 + L / (white * white)) / (1 + L)
    for (let c = 0; c < 3; ++c) out[4 * v + c] = Math.round(65535 * Math.min(1, Math.max(0, B[c] * scale)))
    out[4 * v + 3] = 65535
  }
  return out
}

export function exportMix(viewer: Viewer): Blob {
  const { solution } = viewer, vertices = solution.positions.length / 3
  const box = viewer.stage.mesh.geometry.boundingBox!
  const views = [solution.positions, solution.normals, colours(viewer), solution.indices]
  let offset = 0
  const bufferViews = views.map((view, i) => {
    const entry = { buffer: 0, byteOffset: offset, byteLength: view.byteLength, target: i === 3 ? 34963 : 34962 }
    offset += pad(view.byteLength)
    return entry
  })
  const json = new TextEncoder().encode(JSON.stringify({
    asset: { version: '2.0', generator: 'Exitance' },
    extensionsUsed: ['KHR_materials_unlit'],
    scene: 0, scenes: [{ nodes: [0] }],
    nodes: [{ name: solution.title || 'solution', mesh: 0, rotation: viewer.turn.toArray() }],
    materials: [{ pbrMetallicRoughness: { metallicFactor: 0 }, extensions: { KHR_materials_unlit: {} } }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 1, COLOR_0: 2 }, indices: 3, material: 0 }] }],
    accessors: [
      { bufferView: 0, componentType: 5126, count: vertices, type: 'VEC3', min: box.min.toArray(), max: box.max.toArray() },
      { bufferView: 1, componentType: 5126, count: vertices, type: 'VEC3' },
      { bufferView: 2, componentType: 5123, normalized: true, count: vertices, type: 'VEC4' },
      { bufferView: 3, componentType: 5125, count: solution.indices.length, type: 'SCALAR' }],
    bufferViews, buffers: [{ byteLength: offset }],
  }))
  const jsonLength = pad(json.length)
  const header = new DataView(new ArrayBuffer(20)), chunk = new DataView(new ArrayBuffer(8))
  const words = [0x46546c67, 2, 28 + jsonLength + offset, jsonLength, 0x4e4f534a]
  words.forEach((word, i) => header.setUint32(4 * i, word, true))
  chunk.setUint32(0, offset, true)
  chunk.setUint32(4, 0x004e4942, true)
  const blobs: BlobPart[] = [header.buffer, json, new Uint8Array(jsonLength - json.length).fill(32), chunk.buffer]
  for (const view of views) blobs.push(new Uint8Array(view.buffer as ArrayBuffer, view.byteOffset, view.byteLength),
    new Uint8Array(pad(view.byteLength) - view.byteLength))
  return new Blob(blobs, { type: 'model/gltf-binary' })
}
