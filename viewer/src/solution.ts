// SPDX-License-Identifier: Apache-2.0
// A solution file (docs/solution-file.md) as arrays: a binary glTF whose vertices carry the light
// of every group.

export interface CameraPlace { name: string; eye: Vec; look_at: Vec; up: Vec; fov_y: number }
export interface SensorGrid { name: string; origin: Vec; u: Vec; v: Vec; normal: Vec; columns: number; rows: number }
export type Vec = [number, number, number]

export interface Pattern { texture: number; factor: Vec; most: number }
export interface Material {
  name: string
  reflectance: Vec
  exitance: Vec
  reflectancePattern?: Pattern
  exitancePattern?: Pattern
}
export interface Part { name: string; firstTriangle: number; triangles: number }
export interface Primitive {
  material: number
  group: number           // light group of its emission
  firstTriangle: number
  triangles: number
  firstVertex: number
  vertices: number
  parts: Part[]
  measured: boolean       // irradiance is in the file, not computed from exitance
}
export interface TextureImage { blob: Blob; wrapS: number; wrapT: number; nearest: boolean }

export interface Solution {
  title: string
  quantity: 'radiometric' | 'photometric' | 'unitless'
  unit: string
  up: Vec
  groups: { name: string; weight: number }[]
  scenes: { name: string; factors: Record<string, number> }[]
  cameras: CameraPlace[]
  grids: SensorGrid[]
  error?: { rms: number; confidence: number; points: number }
  energy: { emitted: number; absorbed: number; absorbed_behind: number; escaped: number; unshot: number }
  materials: Material[]
  primitives: Primitive[]
  textures: TextureImage[]
  positions: Float32Array
  normals: Float32Array
  uv0?: Float32Array
  uv1?: Float32Array
  indices: Uint32Array
  exitance: Float32Array[]     // per group: vertices x RGB
  unshot?: Float32Array        // while it is being solved: exitance still to be sent on, luminance
  irradiance: Float32Array[]   // per group, where it was stored, else zero; see irradianceOf()
}

interface Accessor { bufferView?: number; byteOffset?: number; count: number; componentType: number; type: string }
/* eslint-disable @typescript-eslint/no-explicit-any */
type Json = any

const FLOAT = 5126, UNSIGNED_INT = 5125
const WIDTH: Record<string, number> = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 }

/** The JSON and the binary chunk. */
function chunks(file: ArrayBuffer): { json: Json; binary: Uint8Array } {
  const view = new DataView(file)
  if (file.byteLength < 20 || view.getUint32(0, true) !== 0x46546c67 || view.getUint32(4, true) !== 2)
    throw Error('This is no binary glTF 2.0.')
  const length = view.getUint32(12, true)
  const json = JSON.parse(new TextDecoder().decode(new Uint8Array(file, 20, length)))
  const start = 20 + length + 8
  return { json, binary: new Uint8Array(file, Math.min(start, file.byteLength)) }
}

class Accessors {
  constructor(private json: Json, private binary: Uint8Array) {}

  get(index: number): Float32Array | Uint32Array {
    const accessor: Accessor = this.json.accessors[index]
    const count = accessor.count * WIDTH[accessor.type]
    const view = this.json.bufferViews[accessor.bufferView!]
    const start = this.binary.byteOffset + (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0)
    if (view.byteStride && view.byteStride !== 4 * WIDTH[accessor.type]) throw Error('Strides are not expected here.')
    if (accessor.componentType === FLOAT) return new Float32Array(this.binary.buffer, start, count)
    if (accessor.componentType === UNSIGNED_INT) return new Uint32Array(this.binary.buffer, start, count)
    throw Error(`Accessor ${index} has components of an unexpected type.`)
  }
  floats(index: number): Float32Array {
    return this.get(index) as Float32Array
  }
}

/** Other bands than red, green and blue are shown as grey of their mean, as `exitance render` does. */
function rgb(values: number[]): Vec {
  if (values.length === 3) return [values[0], values[1], values[2]]
  const mean = values.reduce((a, b) => a + b, 0) / values.length
  return [mean, mean, mean]
}

/** Adds one group's light of a primitive, attribute by attribute, to the RGB of its vertices. */
function addColumns(out: Float32Array, firstVertex: number, attributes: Float32Array[], bands: number): void {
  if (bands === 3) {
    out.set(attributes[0], 3 * firstVertex)
    return
  }
  for (const attribute of attributes)
    for (let v = 0; v < attribute.length / 3; ++v) {
      const grey = (attribute[3 * v] + attribute[3 * v + 1] + attribute[3 * v + 2]) / bands
      for (let c = 0; c < 3; ++c) out[3 * (firstVertex + v) + c] += grey
    }
}

function readMaterial(node: Json): Material {
  const extras = node.extras.exitance
  const pattern = (given: Json): Pattern | undefined =>
    given && { texture: given.texture, factor: rgb(given.factor), most: given.most }
  return {
    name: node.name ?? '',
    reflectance: rgb(extras.reflectance),
    exitance: rgb(extras.exitance),
    reflectancePattern: pattern(extras.reflectance_pattern),
    exitancePattern: pattern(extras.exitance_pattern),
  }
}

function readTexture(json: Json, binary: Uint8Array, texture: Json): TextureImage {
  const view = json.bufferViews[json.images[texture.source].bufferView]
  const bytes = binary.slice(view.byteOffset ?? 0, (view.byteOffset ?? 0) + view.byteLength)
  const sampler = json.samplers?.[texture.sampler] ?? {}
  return {
    blob: new Blob([bytes], { type: json.images[texture.source].mimeType }),
    wrapS: sampler.wrapS ?? 10497, wrapT: sampler.wrapT ?? 10497, nearest: sampler.magFilter === 9728,
  }
}

export function readSolution(file: ArrayBuffer): Solution {
  const { json, binary } = chunks(file)
  const extras = json.asset?.extras?.exitance
  if (!extras) throw Error('This glTF carries no solution of Exitance.')
  if (extras.format !== 1) throw Error(`This solution has format ${extras.format}, expected 1.`)
  const accessors = new Accessors(json, binary)
  const given: Json[] = json.meshes[0].primitives
  const bands: number = extras.bands.length, perGroup = Math.ceil(bands / 3)

  let vertices = 0, triangles = 0
  for (const p of given) {
    vertices += json.accessors[p.attributes.POSITION].count
    triangles += json.accessors[p.indices].count / 3
  }
  const patterned = given.some((p) => 'TEXCOORD_0' in p.attributes || 'TEXCOORD_1' in p.attributes)
  const columns = () => extras.groups.map(() => new Float32Array(3 * vertices))
  const out: Solution = {
    title: extras.title, quantity: extras.quantity, unit: extras.exitance_unit, up: extras.up,
    groups: extras.groups, scenes: extras.scenes ?? [], cameras: extras.cameras ?? [],
    grids: extras.grids ?? [], error: extras.error, energy: extras.energy,
    materials: json.materials.map(readMaterial), primitives: [],
    textures: (json.textures ?? []).map((t: Json) => readTexture(json, binary, t)),
    positions: new Float32Array(3 * vertices), normals: new Float32Array(3 * vertices),
    uv0: patterned ? new Float32Array(2 * vertices) : undefined,
    uv1: patterned ? new Float32Array(2 * vertices) : undefined,
    unshot: given.length > 0 && given.every((p) => '_UNSHOT' in p.attributes) ? new Float32Array(vertices) : undefined,
    indices: new Uint32Array(3 * triangles), exitance: columns(), irradiance: columns(),
  }

  let vertex = 0, triangle = 0
  for (const p of given) {
    const attributes = p.attributes
    const count: number = json.accessors[attributes.POSITION].count
    const indices = accessors.get(p.indices)
    for (let i = 0; i < indices.length; ++i) out.indices[3 * triangle + i] = indices[i] + vertex
    out.positions.set(accessors.floats(attributes.POSITION), 3 * vertex)
    out.normals.set(accessors.floats(attributes.NORMAL), 3 * vertex)
    if ('TEXCOORD_0' in attributes) out.uv0!.set(accessors.floats(attributes.TEXCOORD_0), 2 * vertex)
    if ('TEXCOORD_1' in attributes) out.uv1!.set(accessors.floats(attributes.TEXCOORD_1), 2 * vertex)
    out.unshot?.set(accessors.floats(attributes._UNSHOT), vertex)
    const stored = (name: string, g: number) =>
      Array.from({ length: perGroup }, (_, k) => accessors.floats(attributes[`${name}_${g * perGroup + k}`]))
    const measured = '_IRRADIANCE_0' in attributes
    for (let g = 0; g < out.groups.length; ++g) {
      addColumns(out.exitance[g], vertex, stored('_EXITANCE', g), bands)
      if (measured) addColumns(out.irradiance[g], vertex, stored('_IRRADIANCE', g), bands)
    }
    let first = triangle
    const parts: Part[] = p.extras.exitance.parts.map((part: Json) => {
      const here = { name: part.name, firstTriangle: first, triangles: part.triangles }
      first += part.triangles
      return here
    })
    out.primitives.push({
      material: p.material, group: p.extras.exitance.group, firstTriangle: triangle,
      triangles: indices.length / 3, firstVertex: vertex, vertices: count, parts, measured,
    })
    if (!measured) deriveIrradiance(out, out.primitives.at(-1)!)
    vertex += count
    triangle += indices.length / 3
  }
  return out
}

/** H = (B - E) / rho; where the file has none, E is 0 and rho at least 0.02 in every band. */
function deriveIrradiance(solution: Solution, primitive: Primitive): void {
  const rho = solution.materials[primitive.material].reflectance
  const inverse = rho.map((r) => 1 / r)
  const start = 3 * primitive.firstVertex, end = start + 3 * primitive.vertices
  solution.exitance.forEach((B, g) => {
    const H = solution.irradiance[g]
    for (let i = start; i < end; i += 3)
      for (let c = 0; c < 3; ++c) H[i + c] = B[i + c] * inverse[c]
  })
}

export function primitiveOfTriangle(solution: Solution, triangle: number): Primitive {
  return within(solution.primitives, triangle)
}

export function partOfTriangle(primitive: Primitive, triangle: number): Part {
  return within(primitive.parts, triangle)
}

/** The last of the sorted ranges that starts at or before `triangle`. */
function within<Range extends { firstTriangle: number }>(ranges: Range[], triangle: number): Range {
  let low = 0, high = ranges.length - 1
  while (low < high) {
    const middle = (low + high + 1) >> 1
    if (ranges[middle].firstTriangle <= triangle) low = middle
    else high = middle - 1
  }
  return ranges[low]
}
