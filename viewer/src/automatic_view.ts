// SPDX-License-Identifier: Apache-2.0
// Where to stand when the scene has no camera: in a room with the back to the farthest wall, else
// outside with all of it in view (as src/exitance/render/automatic_view.cpp).

import * as THREE from 'three'
import type { MeshBVH } from 'three-mesh-bvh'
import { type Pose, poseLooking } from './pose'

/** `bvh` and `box` in the frame of the scene, `turn` from there to the page. */
export function automaticView(bvh: MeshBVH, box: THREE.Box3, turn: THREE.Quaternion): Pose {
  const middle = box.getCenter(new THREE.Vector3()), diagonal = Math.max(box.getSize(new THREE.Vector3()).length(), 1e-6)
  const back = turn.clone().invert(), page = (v: THREE.Vector3) => v.clone().applyQuaternion(turn)
  const free = (direction: THREE.Vector3) => {
    const hit = bvh.raycastFirst(new THREE.Ray(middle, direction.clone().applyQuaternion(back)), THREE.FrontSide)
    return hit ? hit.distance : 0
  }
  let met = 0
  const directions = 128, golden = Math.PI * (3 - Math.sqrt(5))
  for (let i = 0; i < directions; ++i) {
    const z = 1 - 2 * (i + 0.5) / directions, r = Math.sqrt(1 - z * z)
    if (free(new THREE.Vector3(r * Math.cos(golden * i), z, r * Math.sin(golden * i))) > 0) ++met
  }
  let longest = 0, farthest = new THREE.Vector3(0, 0, 1)
  for (let i = 0; i < 64; ++i) {
    const d = new THREE.Vector3(Math.sin(2 * Math.PI * i / 64), 0, Math.cos(2 * Math.PI * i / 64))
    const reach = free(d)
    if (reach > longest) {
      longest = reach
      farthest = d
    }
  }
  const centre = page(middle)
  if (met > 0.6 * directions && longest > 0.05 * diagonal) {
    const at = centre.clone().addScaledVector(farthest, -0.25 * longest)
    at.y -= 0.05 * longest
    return poseLooking(centre.clone().addScaledVector(farthest, 0.92 * longest), at, 65)
  }
  const fov = 40, distance = 0.52 * diagonal / Math.sin(fov * Math.PI / 360)
  const towards = new THREE.Vector3(0.45, 0.45, 0.75).normalize()
  return poseLooking(centre.clone().addScaledVector(towards, distance), centre, fov)
}
