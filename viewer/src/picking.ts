// SPDX-License-Identifier: Apache-2.0
// What lies under the pointer, and how much light arrives there and leaves it.

import * as THREE from 'three'
import type { LitMesh } from './lit_mesh'
import { partOfTriangle, primitiveOfTriangle, type Solution } from './solution'
import { luminance } from './tone'

export interface Place {
  point: THREE.Vector3     // in the scene's frame [m]
  normal: THREE.Vector3    // of the lit side
  triangle: number
  barycentric: [number, number, number]
  distance: number
}

export interface Reading {
  surface: string
  material: string
  point: THREE.Vector3
  normal: THREE.Vector3
  illuminance: number           // sum over the groups as they are mixed [unit of the solution]
  exitance: number
  irradianceRgb: [number, number, number]
  shares: number[]              // of the illuminance, per group, 0 ... 1
  distance: number
}

export type Section = THREE.Vector4  // in the page's frame; shown where dot(xyz, p) <= w

/** The nearest lit side that `ray` meets, in the page's frame; nothing beyond the section. */
export function pick(mesh: LitMesh, solution: Solution, ray: THREE.Ray, section?: Section): Place | null {
  const back = mesh.quaternion.clone().invert()
  const local = new THREE.Ray(ray.origin.clone().applyQuaternion(back), ray.direction.clone().applyQuaternion(back))
  const isShown = (p: THREE.Vector3) => {
    if (!section || section.lengthSq() === 0) return true
    const q = p.clone().applyQuaternion(mesh.quaternion)
    return q.x * section.x + q.y * section.y + q.z * section.z <= section.w
  }
  const cut = section && section.lengthSq() > 0
  const hit = cut
    ? mesh.bvh.raycast(local, THREE.FrontSide).filter((h) => isShown(h.point)).sort((a, b) => a.distance - b.distance)[0]
    : mesh.bvh.raycastFirst(local, THREE.FrontSide)
  if (!hit) return null
  const triangle = hit.faceIndex as number
  const corner = (k: number) => new THREE.Vector3().fromArray(solution.positions, 3 * solution.indices[3 * triangle + k])
  const [a, b, c] = [corner(0), corner(1), corner(2)]
  const weights = THREE.Triangle.getBarycoord(hit.point, a, b, c, new THREE.Vector3()) ?? new THREE.Vector3(1, 0, 0)
  const normal = new THREE.Triangle(a, b, c).getNormal(new THREE.Vector3())
  return { point: hit.point.clone(), normal, triangle, barycentric: [weights.x, weights.y, weights.z], distance: hit.distance }
}

/** Hands over the triangles that may reach into `box`, both in the page's frame. */
export function trianglesWithin(mesh: LitMesh, box: THREE.Box3,
  each: (a: THREE.Vector3, b: THREE.Vector3, c: THREE.Vector3) => void): void {
  const turn = mesh.quaternion
  const local = box.clone().applyMatrix4(new THREE.Matrix4().makeRotationFromQuaternion(turn.clone().invert()))
  mesh.bvh.shapecast({
    intersectsBounds: (bounds) => bounds.intersectsBox(local),
    intersectsTriangle: ({ a, b, c }) => {
      each(a.clone().applyQuaternion(turn), b.clone().applyQuaternion(turn), c.clone().applyQuaternion(turn))
      return false
    },
  })
}

/** `factors`: three per group, as they are shown. */
export function read(solution: Solution, place: Place, factors: number[]): Reading {
  const primitive = primitiveOfTriangle(solution, place.triangle)
  const interpolated = (values: Float32Array, c: number) => {
    let sum = 0
    for (let k = 0; k < 3; ++k) sum += place.barycentric[k] * values[3 * solution.indices[3 * place.triangle + k] + c]
    return sum
  }
  const total = (of: Float32Array[]) => of.map((values, g) =>
    [0, 1, 2].map((c) => factors[3 * g + c] * interpolated(values, c)) as [number, number, number])
  const H = total(solution.irradiance), B = total(solution.exitance)
  const sum = (of: [number, number, number][]) => of.reduce((s, v) => s + luminance(...v), 0)
  const illuminance = sum(H)
  return {
    surface: partOfTriangle(primitive, place.triangle).name,
    material: solution.materials[primitive.material].name,
    point: place.point, normal: place.normal, illuminance, exitance: sum(B),
    irradianceRgb: [0, 1, 2].map((c) => H.reduce((s, v) => s + v[c], 0)) as [number, number, number],
    shares: H.map((v) => (illuminance > 0 ? luminance(...v) / illuminance : 0)), distance: place.distance,
  }
}
