// SPDX-License-Identifier: Apache-2.0
// A solution file of any size without solving: a wavy floor, lit by made-up light groups, with the
// extras of a file that was solved.
import { readFileSync, writeFileSync } from 'node:fs'

/** Writes `path` with 2 cells x cells triangles and so many groups; returns the number of triangles. */
export function writeLargeSolution(path, solved, cells, groups) {
  const file = readFileSync(solved)
  const json = JSON.parse(file.subarray(20, 20 + file.readUInt32LE(12)).toString())
  const side = cells + 1, vertices = side * side
  const position = new Float32Array(3 * vertices), normal = new Float32Array(3 * vertices)
  const preview = new Uint16Array(4 * vertices).fill(30000), indices = new Uint32Array(6 * cells * cells)
  const light = Array.from({ length: groups }, () => new Float32Array(3 * vertices))
  for (let v = 0; v < vertices; ++v) {
    const x = 4 * (v % side) / cells, z = 4 * Math.floor(v / side) / cells
    position.set([x, 0.05 * Math.sin(7 * x) * Math.cos(5 * z), -z], 3 * v)
    normal[3 * v + 1] = 1
    light.forEach((B, g) => {
      const value = 50 + 40 * Math.sin((g + 1) * x) * Math.cos((g + 2) * z)
      B.set([value, 0.9 * value, 0.7 * value], 3 * v)
    })
  }
  for (let k = 0; k < cells * cells; ++k) {
    const a = Math.floor(k / cells) * side + k % cells, b = a + side
    indices.set([a, a + 1, b + 1, a, b + 1, b], 6 * k)
  }
  const views = [position, normal, preview, ...light, indices]
  const attributes = { POSITION: 0, NORMAL: 1, COLOR_0: 2 }
  light.forEach((_, g) => (attributes[`_EXITANCE_${g}`] = 3 + g))
  let offset = 0
  json.bufferViews = views.map((view) => {
    const entry = { buffer: 0, byteOffset: offset, byteLength: view.byteLength }
    offset += view.byteLength + (4 - view.byteLength % 4) % 4
    return entry
  })
  json.accessors = views.map((view, i) => {
    const kind = view instanceof Uint16Array ? [5123, 'VEC4', 4] : view instanceof Uint32Array ? [5125, 'SCALAR', 1] : [5126, 'VEC3', 3]
    return { bufferView: i, componentType: kind[0], type: kind[1], count: view.length / kind[2],
      ...(i === 2 ? { normalized: true } : {}), ...(i === 0 ? { min: [0, -0.05, -4], max: [4, 0.05, 0] } : {}) }
  })
  const about = json.asset.extras.exitance
  about.groups = light.map((_, g) => ({ name: `lamp ${g + 1}`, weight: 1 }))
  for (const name of ['emitters', 'luminaires', 'photometries', 'distant_lights', 'scenes']) delete about[name]
  about.grids = []
  about.cameras = [{ name: 'above', eye: [2, 2.5, 1.5], look_at: [2, 0, -2], up: [0, 1, 0], fov_y: 50 }]
  json.materials = [{ name: 'floor', extensions: { KHR_materials_unlit: {} },
    extras: { exitance: { reflectance: [0.6, 0.6, 0.6], exitance: [0, 0, 0], two_sided: false } } }]
  json.meshes = [{ primitives: [{ attributes, indices: views.length - 1, material: 0,
    extras: { exitance: { group: 0, parts: [{ name: 'floor', order: 0, triangles: 2 * cells * cells }] } } }] }]
  json.buffers = [{ byteLength: offset }]

  let text = Buffer.from(JSON.stringify(json))
  text = Buffer.concat([text, Buffer.alloc((4 - text.length % 4) % 4, ' ')])
  const head = Buffer.alloc(20), chunk = Buffer.alloc(8)
  ;[0x46546c67, 2, 28 + text.length + offset, text.length, 0x4e4f534a].forEach((word, i) => head.writeUInt32LE(word, 4 * i))
  chunk.writeUInt32LE(offset, 0)
  chunk.writeUInt32LE(0x004e4942, 4)
  const bytes = views.flatMap((v) => [Buffer.from(v.buffer), Buffer.alloc((4 - v.byteLength % 4) % 4)])
  writeFileSync(path, Buffer.concat([head, text, chunk, ...bytes]))
  return 2 * cells * cells
}
