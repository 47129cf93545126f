// SPDX-License-Identifier: Apache-2.0
// Where the eye is and where it looks, in the page's frame: metres, y up.

import * as THREE from 'three'
import type { CameraPlace } from './solution'

export interface Pose {
  eye: THREE.Vector3
  azimuth: number    // of the line of sight, radians: 0 looks along -z, grows to the left
  elevation: number  // radians above the level
  distance: number   // to the point that orbiting turns about [m]
  fov: number        // vertical, degrees
}

const MOST_ELEVATION = Math.PI / 2 - 1e-4

export function lineOfSight(pose: Pose): THREE.Vector3 {
  const level = Math.cos(pose.elevation)
  return new THREE.Vector3(-Math.sin(pose.azimuth) * level, Math.sin(pose.elevation), -Math.cos(pose.azimuth) * level)
}

/** The point that orbiting turns about. */
export function reference(pose: Pose): THREE.Vector3 {
  return pose.eye.clone().addScaledVector(lineOfSight(pose), pose.distance)
}

export function poseLooking(eye: THREE.Vector3, at: THREE.Vector3, fov: number): Pose {
  const way = at.clone().sub(eye)
  const distance = Math.max(way.length(), 1e-6)
  way.divideScalar(distance)
  return { eye: eye.clone(), azimuth: Math.atan2(-way.x, -way.z), elevation: limited(Math.asin(clamp(way.y))), distance, fov }
}

const clamp = (v: number) => Math.min(1, Math.max(-1, v))
export const limited = (elevation: number) => Math.min(MOST_ELEVATION, Math.max(-MOST_ELEVATION, elevation))

export function copyOf(pose: Pose): Pose {
  return { ...pose, eye: pose.eye.clone() }
}

/** Turns the line of sight about the eye. */
export function turned(pose: Pose, azimuth: number, elevation: number): Pose {
  return { ...pose, azimuth: pose.azimuth + azimuth, elevation: limited(pose.elevation + elevation) }
}

/** Turns the eye about the reference point. */
export function orbited(pose: Pose, azimuth: number, elevation: number): Pose {
  const centre = reference(pose), out = turned(pose, azimuth, elevation)
  out.eye = centre.addScaledVector(lineOfSight(out), -pose.distance)
  return out
}

/** Nearer to the reference point, or farther: factor < 1 or > 1. */
export function zoomed(pose: Pose, factor: number): Pose {
  const centre = reference(pose), distance = Math.min(Math.max(pose.distance * factor, 0.01), 1e5)
  return { ...pose, distance, eye: centre.addScaledVector(lineOfSight(pose), -distance) }
}

/** Eye and reference together. */
export function moved(pose: Pose, by: THREE.Vector3): Pose {
  return { ...pose, eye: pose.eye.clone().add(by) }
}

/** On the way from one pose to another: the eye on a line, the sight on the shorter arc. */
export function between(a: Pose, b: Pose, t: number): Pose {
  const s = t * t * (3 - 2 * t)
  const mix = (x: number, y: number) => x + (y - x) * s
  const arc = Math.atan2(Math.sin(b.azimuth - a.azimuth), Math.cos(b.azimuth - a.azimuth))
  return {
    eye: a.eye.clone().lerp(b.eye, s), azimuth: a.azimuth + arc * s, elevation: mix(a.elevation, b.elevation),
    distance: mix(a.distance, b.distance), fov: mix(a.fov, b.fov),
  }
}

/** From the scene's axes to the page's, in which y is up: the shortest turn. */
export function turnOfUp(up: readonly number[]): THREE.Quaternion {
  return new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(...up).normalize(), new THREE.Vector3(0, 1, 0))
}

export function poseOfCamera(camera: CameraPlace, turn: THREE.Quaternion): Pose {
  const page = (v: readonly number[]) => new THREE.Vector3(v[0], v[1], v[2]).applyQuaternion(turn)
  return poseLooking(page(camera.eye), page(camera.look_at), camera.fov_y)
}

export function applyPose(pose: Pose, camera: THREE.PerspectiveCamera): void {
  camera.position.copy(pose.eye)
  camera.rotation.set(pose.elevation, pose.azimuth, 0, 'YXZ')
  camera.fov = pose.fov
  camera.updateProjectionMatrix()
  camera.updateMatrixWorld()
}
