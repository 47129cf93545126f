// SPDX-License-Identifier: Apache-2.0
// A solution as meshes: all vertices lie on the graphics card once, the light of each group as an
// attribute of its own, so that a slider changes a few numbers and nothing else.

import * as THREE from 'three'
import { MeshBVH } from 'three-mesh-bvh'
import { rimsAround, rimsOf } from './rims'
import { type Columns, floatTexture, type LookUniforms, REST_WIDTH, surfaceMaterial } from './shading'
import { meshLines } from './subdivision'
import type { Primitive, Solution, TextureImage } from './solution'

// WebGL 2 promises 16 attributes; position, normal and two texture places take four. The light of
// further groups lies in a texture.
const MOST_COLUMNS = 12

async function texture(image: TextureImage): Promise<THREE.Texture> {
  const out = new THREE.Texture(await createImageBitmap(image.blob, { colorSpaceConversion: 'none', premultiplyAlpha: 'none' }))
  const wrap: Record<number, THREE.Wrapping> = { 10497: THREE.RepeatWrapping, 33071: THREE.ClampToEdgeWrapping, 33648: THREE.MirroredRepeatWrapping }
  out.wrapS = wrap[image.wrapS]
  out.wrapT = wrap[image.wrapT]
  if (image.nearest) out.magFilter = THREE.NearestFilter
  out.flipY = false
  out.colorSpace = THREE.SRGBColorSpace
  out.needsUpdate = true
  return out
}

function same(a: Float32Array | Uint32Array, b: Float32Array | Uint32Array): boolean {
  return a.length === b.length && a.every((v, i) => v === b[i])
}

function replace(mesh: THREE.Mesh, column: number, values: Float32Array): void {
  const attribute = mesh.geometry.getAttribute(`column${column}`) as THREE.BufferAttribute
  if (same(attribute.array as Float32Array, values)) return
  attribute.array = values
  attribute.needsUpdate = true
}

function grey(values: Float32Array): Float32Array {
  return Float32Array.from({ length: 3 * values.length }, (_, i) => values[Math.floor(i / 3)])
}

const isPatterned = (solution: Solution, p: Primitive) =>
  !!(solution.materials[p.material].reflectancePattern || solution.materials[p.material].exitancePattern)

export class LitMesh extends THREE.Group {
  readonly geometry = new THREE.BufferGeometry()
  private tree?: MeshBVH
  private shine: THREE.Mesh          // columns: exitance
  private receive: THREE.Mesh        // columns: irradiance; patterns, and everything when it is measured
  private waiting?: THREE.Mesh       // column: what is still unshot
  private wires?: THREE.Group
  private wiresShown = false
  private columns: number
  private restLight: THREE.DataTexture[] = []

  private constructor(private solution: Solution, private shared: LookUniforms, textures: THREE.Texture[]) {
    super()
    this.columns = Math.min(MOST_COLUMNS, solution.groups.length)
    const attribute = (values: Float32Array, width: number) => new THREE.BufferAttribute(values, width)
    this.geometry.setAttribute('position', attribute(solution.positions, 3))
    this.geometry.setIndex(new THREE.BufferAttribute(solution.indices, 1))
    this.geometry.setAttribute('normal', attribute(solution.normals, 3))
    if (solution.uv0) this.geometry.setAttribute('uv0', attribute(solution.uv0, 2))
    if (solution.uv1) this.geometry.setAttribute('uv1', attribute(solution.uv1, 2))
    const shining = this.withColumns(solution.exitance), receiving = this.withColumns(solution.irradiance)
    this.shine = new THREE.Mesh(shining, this.materials(shining, 'exitance', textures))
    this.receive = new THREE.Mesh(receiving, this.materials(receiving, 'irradiance', textures))
    const box = new THREE.Box3().setFromBufferAttribute(this.geometry.getAttribute('position') as THREE.BufferAttribute)
    this.geometry.boundingBox = box
    if (solution.unshot) this.waiting = this.unshot(solution.unshot)
    const rims = rimsOf(solution)
    for (const mesh of [this.shine, this.receive, this.waiting]) {
      if (!mesh) continue
      if (rims) mesh.add(rimsAround(mesh, rims))
      mesh.traverse((part) => (part.frustumCulled = false))
      this.add(mesh)
    }
    this.showColumns('exitance')
  }

  /** What answers rays; made when first asked for. In the order of the file: a triangle's number says
   * which surface it belongs to. */
  get bvh(): MeshBVH {
    return (this.tree ??= new MeshBVH(this.geometry, { indirect: true }))
  }

  static async make(solution: Solution, shared: LookUniforms): Promise<LitMesh> {
    return new LitMesh(solution, shared, await Promise.all(solution.textures.map(texture)))
  }

  /** How many factors the shader takes: the groups, or fewer where they are too many. */
  static columnsOf(solution: Solution): number {
    return Math.min(MOST_COLUMNS, solution.groups.length)
  }

  /** Shows another revision where only the light differs; whether it does. */
  continueWith(solution: Solution): boolean {
    const now = this.solution
    const shape = (s: Solution) => JSON.stringify([s.primitives, s.materials, s.groups, s.textures.length])
    if (solution.groups.length > this.columns || !same(now.indices, solution.indices) || !same(now.positions, solution.positions) || !same(now.normals, solution.normals)
      || shape(now) !== shape(solution) || !now.unshot !== !solution.unshot) return false
    for (const [mesh, columns] of [[this.shine, 'exitance'], [this.receive, 'irradiance']] as const)
      solution[columns].slice(0, this.columns).forEach((column, k) => {
        replace(mesh, k, column)
      })
    if (this.waiting) replace(this.waiting, 0, grey(solution.unshot!))
    this.solution = solution
    return true
  }

  private withColumns(values: Float32Array[]): THREE.BufferGeometry {
    const out = new THREE.BufferGeometry()
    out.setIndex(this.geometry.index)
    for (const [name, attribute] of Object.entries(this.geometry.attributes)) out.setAttribute(name, attribute)
    values.slice(0, this.columns).forEach((column, k) =>
      out.setAttribute(`column${k}`, new THREE.BufferAttribute(column, 3)))
    return out
  }

  /** The light of the groups that are no columns, one after the other. */
  private rest(values: Float32Array[]): THREE.DataTexture | undefined {
    const rest = values.slice(this.columns), vertices = this.solution.positions.length / 3
    if (rest.length === 0) return undefined
    const out = floatTexture(REST_WIDTH, Math.ceil(rest.length * vertices / REST_WIDTH))
    rest.forEach((light, k) => {
      const texels = (out.image.data as unknown as Float32Array).subarray(4 * k * vertices)
      for (let v = 0; v < vertices; ++v)
        for (let c = 0; c < 3; ++c) texels[4 * v + c] = light[3 * v + c]
    })
    return out
  }

  /** One draw per run of primitives that look alike. */
  private materials(geometry: THREE.BufferGeometry, are: Columns['are'], textures: THREE.Texture[]): THREE.Material[] {
    const out: THREE.Material[] = []
    const { groups, positions } = this.solution
    const columns: Columns = { are, count: this.columns, rest: groups.length - this.columns, restLight: this.rest(this.solution[are]),
      vertices: positions.length / 3 }
    if (columns.restLight) this.restLight.push(columns.restLight)
    for (const p of this.solution.primitives) {
      geometry.addGroup(3 * p.firstTriangle, 3 * p.triangles, out.length)
      const material = surfaceMaterial(columns, this.solution.materials[p.material], p.group, textures, this.shared)
      material.visible = are === 'irradiance' || !isPatterned(this.solution, p)
      out.push(material)
    }
    return out
  }

  /** One column of what is still unshot, the same in all bands. */
  private unshot(values: Float32Array): THREE.Mesh {
    const geometry = this.withColumns([grey(values)])
    const columns: Columns = { are: 'exitance', count: 1, rest: 0, vertices: values.length }
    const shared = { ...this.shared, factors: { value: new Float32Array([1, 1, 1]) } }
    const [material] = this.solution.materials
    return new THREE.Mesh(geometry, surfaceMaterial(columns, { ...material, reflectancePattern: undefined, exitancePattern: undefined },
      0, [], shared))
  }

  /** Draws from the exitance, where no pattern makes it vary within a triangle; from the irradiance of
   * all surfaces; or what is still unshot. */
  showColumns(which: 'exitance' | 'irradiance' | 'unshot'): void {
    this.shine.visible = which === 'exitance'
    const shown = this.solution.primitives.map((p) => which === 'irradiance' || isPatterned(this.solution, p))
    for (const part of [this.receive, ...this.receive.children] as THREE.Mesh[])
      (part.material as THREE.Material[]).forEach((material, i) => (material.visible = shown[i]))
    this.receive.visible = which !== 'unshot' && shown.includes(true)
    if (this.waiting) this.waiting.visible = which === 'unshot'
  }

  /** Lines, but not beyond the planes of `cut`. */
  showWires(shown: boolean, cut: THREE.Plane[]): void {
    if (shown && !this.wires) {
      this.wires = meshLines(this.solution, this.geometry.getAttribute('position') as THREE.BufferAttribute, cut)
      this.add(this.wires)
    }
    this.wiresShown = shown
    this.linesVisible = true
  }
  /** Whether lines that are asked for are drawn now. */
  set linesVisible(visible: boolean) {
    if (this.wires) this.wires.visible = visible && this.wiresShown
  }
  /** The levels of the lines that are shown. */
  get levels(): number[] {
    return this.wires?.children.map((lines) => lines.userData.level as number) ?? []
  }

  /** Sets what each group counts; `factors` are three per group. */
  setFactors(factors: number[]): void {
    const { factors: columns, groupFactors, restFactors } = this.shared
    groupFactors.value.set(factors)
    columns.value.set(factors.slice(0, 3 * this.columns))
    const rest = restFactors.value.image.data as unknown as Float32Array
    for (let i = 3 * this.columns; i < factors.length; ++i) {
      const k = i - 3 * this.columns
      rest[4 * Math.floor(k / 3) + k % 3] = factors[i]
    }
    restFactors.value.needsUpdate = true
  }

  dispose(): void {
    for (const mesh of [this.shine, this.receive, this.waiting])
      for (const { geometry, material } of (mesh ? [mesh, ...mesh.children] : []) as THREE.Mesh[]) {
        geometry.dispose()
        for (const each of [material].flat()) each.dispose()
      }
    for (const texture of this.restLight) texture.dispose()
    this.geometry.dispose()
    for (const lines of (this.wires?.children ?? []) as THREE.LineSegments[]) {
      lines.geometry.dispose()
      ;(lines.material as THREE.Material).dispose()
    }
  }
}
