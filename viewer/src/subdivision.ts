// SPDX-License-Identifier: Apache-2.0
// The mesh as lines, coloured by how often its elements were halved.

import * as THREE from 'three'
import type { Solution } from './solution'

export const MOST_LEVEL = 8

/** Other colours than those of the quantities: from blue by green and yellow to red and violet. */
export function colourOfLevel(level: number): THREE.Color {
  return new THREE.Color().setHSL(((215 - 38 * level + 360) % 360) / 360, 0.85, 0.6)
}

/** Per triangle: how often the longest edge of its surface was halved to give its own. The triangles that
 * join a coarse element to finer ones have edges between, and count as the coarser. */
export function levelsOfTriangles(solution: Solution): Uint8Array {
  const { indices, positions } = solution, out = new Uint8Array(indices.length / 3)
  const longest = new Float32Array(out.length)
  const distance = (a: number, b: number) => Math.hypot(positions[3 * a] - positions[3 * b],
    positions[3 * a + 1] - positions[3 * b + 1], positions[3 * a + 2] - positions[3 * b + 2])
  for (let t = 0; t < out.length; ++t) {
    const [a, b, c] = [indices[3 * t], indices[3 * t + 1], indices[3 * t + 2]]
    longest[t] = Math.max(distance(a, b), distance(b, c), distance(c, a))
  }
  for (const primitive of solution.primitives)
    for (const { firstTriangle, triangles } of primitive.parts) {
      let most = 0
      for (let t = firstTriangle; t < firstTriangle + triangles; ++t) most = Math.max(most, longest[t])
      for (let t = firstTriangle; t < firstTriangle + triangles; ++t)
        out[t] = Math.min(MOST_LEVEL, Math.floor(Math.log2(most / longest[t]) + 0.25))
    }
  return out
}

/** Each edge once, in the level of the finer of its triangles; nothing beyond the planes of `cut`. */
export function meshLines(solution: Solution, position: THREE.BufferAttribute, cut: THREE.Plane[]): THREE.Group {
  const levels = levelsOfTriangles(solution), { indices } = solution, vertices = position.count
  const edges = new Map<number, number>()
  for (let t = 0; t < levels.length; ++t)
    for (let k = 0; k < 3; ++k) {
      const a = indices[3 * t + k], b = indices[3 * t + (k + 1) % 3]
      const key = Math.min(a, b) * vertices + Math.max(a, b)
      edges.set(key, Math.max(levels[t], edges.get(key) ?? 0))
    }
  const byLevel = Array.from({ length: MOST_LEVEL + 1 }, () => [] as number[])
  for (const [key, level] of edges) byLevel[level].push(Math.floor(key / vertices), key % vertices)
  const out = new THREE.Group()
  byLevel.forEach((pairs, level) => {
    if (pairs.length === 0) return
    const geometry = new THREE.BufferGeometry()
    geometry.setAttribute('position', position)
    geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(pairs), 1))
    const lines = new THREE.LineSegments(geometry, lineMaterial(colourOfLevel(level), cut))
    lines.frustumCulled = false
    lines.userData.level = level
    out.add(lines)
  })
  return out
}

/** A hair nearer than the surfaces that the lines lie on. */
function lineMaterial(color: THREE.Color, clippingPlanes: THREE.Plane[]): THREE.LineBasicMaterial {
  const out = new THREE.LineBasicMaterial({ color, transparent: true, opacity: 0.8, toneMapped: false, clippingPlanes })
  out.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader.replace('#include <logdepthbuf_vertex>', '#include <logdepthbuf_vertex>\ngl_Position.z -= 2e-4 * gl_Position.w;')
  }
  return out
}
