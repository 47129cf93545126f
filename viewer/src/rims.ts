// SPDX-License-Identifier: Apache-2.0
// Where surfaces meet, the vertices of one do not lie where those of the other do, and a graphics card that rounds
// leaves pixels between them open. Their rims, drawn as lines behind everything, close these.

import * as THREE from 'three'
import type { Solution } from './solution'

const MOST = 1 << 20  // lines; so many polygons of their own are small on the screen

/** The edges that belong to one triangle alone: pairs of vertices, and where those of each primitive begin. */
export function rimsOf(solution: Solution): { pairs: Uint32Array; first: number[] } | undefined {
  const { indices, primitives } = solution, pairs: number[] = [], first: number[] = []
  for (const { firstTriangle, triangles, firstVertex, vertices } of primitives) {
    first.push(pairs.length)
    // Edges by the numbers of their ends: how often each occurs, in a table of open places.
    const size = 2 ** Math.ceil(Math.log2(6 * triangles + 1)), start = 3 * firstTriangle
    const keys = new Float64Array(size).fill(-1), twice = new Uint8Array(size), slots = new Uint32Array(3 * triangles)
    const end = (i: number) => indices[i % 3 === 2 ? i - 2 : i + 1]
    for (let i = start; i < start + 3 * triangles; ++i) {
      const a = indices[i] - firstVertex, b = end(i) - firstVertex
      const key = Math.min(a, b) * vertices + Math.max(a, b)
      let slot = (Math.imul(a + b, 0x9e3779b1) ^ Math.imul(Math.abs(a - b), 0x85ebca6b)) >>> 0 & (size - 1)
      while (keys[slot] !== -1 && keys[slot] !== key) slot = (slot + 1) & (size - 1)
      if (keys[slot] === key) twice[slot] = 1
      keys[slot] = key
      slots[i - start] = slot
    }
    for (let i = start; i < start + 3 * triangles; ++i) if (!twice[slots[i - start]]) pairs.push(indices[i], end(i))
    if (pairs.length > 2 * MOST) return undefined
  }
  return { pairs: Uint32Array.from(pairs), first: [...first, pairs.length] }
}

/** The rims of what `mesh` shows, lit as it is; its materials are one per primitive, or one for all. */
export function rimsAround(mesh: THREE.Mesh, { pairs, first }: { pairs: Uint32Array; first: number[] }): THREE.LineSegments {
  const geometry = new THREE.BufferGeometry()
  for (const [name, attribute] of Object.entries(mesh.geometry.attributes)) geometry.setAttribute(name, attribute)
  geometry.setIndex(new THREE.BufferAttribute(pairs, 1))
  first.slice(1).forEach((end, i) => geometry.addGroup(first[i], end - first[i], i))
  const materials = mesh.material as THREE.RawShaderMaterial | THREE.RawShaderMaterial[]
  return new THREE.LineSegments(geometry, Array.isArray(materials) ? materials.map(rimMaterial) : rimMaterial(materials))
}

function rimMaterial({ glslVersion, vertexShader, fragmentShader, uniforms, visible }: THREE.RawShaderMaterial): THREE.RawShaderMaterial {
  return new THREE.RawShaderMaterial({ glslVersion, vertexShader, fragmentShader, uniforms, visible, defines: { RIM: 1 } })
}
