// SPDX-License-Identifier: Apache-2.0
// Who walks is an upright cylinder, from the knees to the crown: what reaches into it is in the way and is slid along;
// what stays below the knees is stepped on. All in the page's frame, y up.

import * as THREE from 'three'

/** Hands over the triangles that reach into a box. */
export type Obstacles = (box: THREE.Box3, each: (a: THREE.Vector3, b: THREE.Vector3, c: THREE.Vector3) => void) => void

export interface Body {
  knees: number   // above the feet: what is lower is stepped on [m]
  crown: number   // above the feet
  radius: number
}

/** Of a person whose eyes are 1.6 m high, or of another size; off the ground only the head counts. */
export const bodyOf = (eyeHeight: number, onFeet: boolean): Body =>
  ({ knees: (onFeet ? 0.35 / 1.6 : 0.85) * eyeHeight, crown: 1.05 * eyeHeight, radius: 0.2 / 1.6 * eyeHeight })

const LEVEL = 0.7  // of a normal that points up: one may stand there

type Flat = [x: number, z: number]

/** The part of a triangle between two heights, seen from above. */
function shadow(corners: THREE.Vector3[], low: number, high: number): Flat[] {
  const clip = (points: THREE.Vector3[], height: number, sign: number) => points.flatMap((p, i) => {
    const q = points[(i + 1) % points.length]
    const dp = sign * (p.y - height), dq = sign * (q.y - height)
    const kept = dp >= 0 ? [p] : []
    return dp * dq < 0 ? [...kept, p.clone().lerp(q, dp / (dp - dq))] : kept
  })
  return clip(clip(corners, low, 1), high, -1).map((p) => [p.x, p.z])
}

/** From the point to the nearest of a convex shadow's edges; nothing from inside it. */
function toShadow(points: Flat[], x: number, z: number): Flat | undefined {
  let nearest: Flat | undefined, least = Infinity, left = 0, right = 0
  points.forEach(([ax, az], i) => {
    const [bx, bz] = points[(i + 1) % points.length]
    const ex = bx - ax, ez = bz - az, length = ex * ex + ez * ez
    const t = length > 0 ? Math.min(1, Math.max(0, ((x - ax) * ex + (z - az) * ez) / length)) : 0
    const way: Flat = [ax + t * ex - x, az + t * ez - z], distance = Math.hypot(...way)
    if (distance < least) [nearest, least] = [way, distance]
    const side = ex * (z - az) - ez * (x - ax), flat = 1e-9 * length
    if (side > flat) ++left
    if (side < -flat) ++right
  })
  const inside = points.length > 2 && left + right > 2 && (left === 0 || right === 0)
  return inside ? undefined : nearest
}

/** How the body at `feet` is pushed out of what reaches deepest into it, in the level. One side of a wall is solid:
 * that which is seen. What one is right inside of is let go of, so that nobody is caught. */
function pushOut(obstacles: Obstacles, feet: THREE.Vector3, body: Body): THREE.Vector3 | undefined {
  const low = feet.y + body.knees, high = feet.y + body.crown, r = body.radius
  const box = new THREE.Box3(new THREE.Vector3(feet.x - r, low, feet.z - r), new THREE.Vector3(feet.x + r, high, feet.z + r))
  const middle = new THREE.Vector3(feet.x, (low + high) / 2, feet.z)
  const met: { plane: THREE.Plane; way: Flat; distance: number }[] = [], inside: THREE.Plane[] = []
  obstacles(box, (a, b, c) => {
    const plane = new THREE.Plane().setFromCoplanarPoints(a, b, c)
    if (Math.abs(plane.normal.y) < LEVEL && plane.distanceToPoint(middle) < 0) return
    const points = shadow([a, b, c], low, high)
    if (points.length < 2) return
    const way = toShadow(points, feet.x, feet.z)
    if (!way) inside.push(plane)
    else if (Math.hypot(...way) < r) met.push({ plane, way, distance: Math.hypot(...way) })
  })
  const [deepest] = met.filter(({ plane, distance }) => distance > 0 && r - distance > 1e-4 * r
    && !inside.some((other) => other.normal.dot(plane.normal) > 0.999 && Math.abs(other.constant - plane.constant) < 0.01 * r))
    .sort((a, b) => a.distance - b.distance)
  return deepest && new THREE.Vector3(-deepest.way[0], 0, -deepest.way[1]).multiplyScalar(r / deepest.distance - 1)
}

/** Where a level `step` from `feet` leads. */
export function walked(obstacles: Obstacles, feet: THREE.Vector3, step: THREE.Vector3, body: Body): THREE.Vector3 {
  const to = slid(obstacles, feet, step, body)
  // Who was put where there is no room, makes himself thin to get out.
  for (const share of [0.5, 0.25])
    if (to.equals(feet) && pushOut(obstacles, feet, body)) to.copy(slid(obstacles, feet, step, { ...body, radius: share * body.radius }))
  return to
}

function slid(obstacles: Obstacles, feet: THREE.Vector3, step: THREE.Vector3, body: Body): THREE.Vector3 {
  // Parts so short that nothing is stepped over.
  const parts = Math.max(1, Math.min(64, Math.ceil(step.length() / (0.5 * body.radius))))
  const part = step.clone().divideScalar(parts)
  if (part.length() > body.radius) part.setLength(body.radius)
  let at = feet.clone()
  for (let i = 0; i < parts; ++i) {
    const to = at.clone().add(part)
    let push: THREE.Vector3 | undefined
    // Out of a corner it takes a push by each wall, and what is left shrinks.
    for (let k = 0; k < 8 && (push = pushOut(obstacles, to, body)); ++k) to.add(push)
    if (push && push.length() > 0.1 * body.radius) return at  // there is no room
    at = to
  }
  return at
}
