// SPDX-License-Identifier: Apache-2.0
// Inside the scene with a headset (WebXR): trigger or right stick forward aims and teleports, the right
// stick turns by 30 degrees, the left stick walks where one looks. One metre is one metre.

import * as THREE from 'three'
import { notifyError } from './notice'
import { poseLooking } from './pose'
import type { Viewer } from './viewer'
import { bodyOf, walked } from './walker'

const SNAP = Math.PI / 6, PUSHED = 0.7, RELEASED = 0.4, IDLE = 0.15

export class Headset {
  private session?: XRSession
  private rig: THREE.Group
  private tracked = new THREE.Matrix4()  // the head, in the frame of the rig
  private turned = false        // the stick must come back before it turns again
  private aiming?: XRInputSource
  private byStick = false
  private aim?: THREE.Vector3   // where one would land, in the page's frame
  private ray = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0xf2b84b }))
  private ring = new THREE.Mesh(new THREE.RingGeometry(0.18, 0.24, 40).rotateX(-Math.PI / 2),
    new THREE.MeshBasicMaterial({ color: 0xf2b84b, side: THREE.DoubleSide, depthTest: false, transparent: true }))

  constructor(private viewer: Viewer, private button: HTMLButtonElement) {
    this.rig = viewer.stage.rig
    this.ray.frustumCulled = this.ray.visible = this.ring.visible = false
    viewer.stage.overlay.add(this.ray, this.ring)
    button.addEventListener('click', () => void this.toggle().catch(notifyError))
    void this.offer()
    navigator.xr?.addEventListener?.('devicechange', () => void this.offer())
  }

  private async offer(): Promise<void> {
    this.button.hidden = !(await navigator.xr?.isSessionSupported('immersive-vr').catch(() => false))
  }

  private async toggle(): Promise<void> {
    if (this.session) return this.session.end()
    const session = await navigator.xr!.requestSession('immersive-vr', { requiredFeatures: ['local-floor'] })
    this.session = session
    session.addEventListener('end', () => this.leave())
    session.addEventListener('selectstart', (event) => {
      this.aiming = event.inputSource
      this.byStick = false
    })
    session.addEventListener('selectend', () => this.land())
    this.stand()
    await this.viewer.stage.renderer.xr.setSession(session)
    this.button.setAttribute('aria-pressed', 'true')
  }

  /** Feet on the ground below where one was, looking the same way. */
  private stand(): void {
    const { pose, movement } = this.viewer
    const ground = movement.feel(pose.eye, new THREE.Vector3(0, -1, 0)) ?? movement.eyeHeight
    this.rig.position.copy(pose.eye).y -= ground
    this.rig.rotation.set(0, pose.azimuth, 0)
    this.rig.updateMatrixWorld(true)
  }

  private leave(): void {
    const eye = this.head, way = this.sight
    this.session = this.aiming = undefined
    this.ray.visible = this.ring.visible = false
    this.rig.position.set(0, 0, 0)
    this.rig.rotation.set(0, 0, 0)
    this.rig.updateMatrixWorld(true)
    this.button.setAttribute('aria-pressed', 'false')
    this.viewer.movement.pose = poseLooking(eye, eye.clone().addScaledVector(way, this.viewer.pose.distance), this.viewer.pose.fov)
    this.viewer.changed()
  }

  /** Before each frame of a session. */
  advance(seconds: number, frame: XRFrame): void {
    if (!this.session) return
    const space = this.viewer.stage.renderer.xr.getReferenceSpace(), pose = space && frame.getViewerPose(space)
    if (pose) this.tracked.fromArray(pose.transform.matrix as unknown as number[])
    for (const source of this.session.inputSources) {
      const axes = source.gamepad?.axes ?? []
      // Mapping "xr-standard": the thumbstick's axes are the third and fourth.
      const [x, y] = [axes[2] ?? 0, axes[3] ?? 0]
      if (source.handedness === 'left') this.walk(x, y, seconds)
      else this.turnOrAim(source, x, y)
    }
    this.point(frame)
    this.keepOnGround(seconds)
    this.rig.updateMatrixWorld(true)
  }

  /** Between the eyes, in the page's frame. */
  private get head(): THREE.Vector3 {
    return new THREE.Vector3().setFromMatrixPosition(this.tracked).applyMatrix4(this.rig.matrixWorld)
  }
  /** Below the head, on the ground of the rig. */
  private get feet(): THREE.Vector3 {
    return this.head.setY(this.rig.position.y)
  }
  private get sight(): THREE.Vector3 {
    return new THREE.Vector3(0, 0, -1).transformDirection(this.tracked).transformDirection(this.rig.matrixWorld)
  }

  private walk(x: number, y: number, seconds: number): void {
    if (Math.hypot(x, y) < IDLE) return
    const ahead = this.sight
    ahead.y = 0
    if (ahead.lengthSq() < 1e-6) return
    ahead.normalize()
    const way = ahead.clone().multiplyScalar(-y).addScaledVector(new THREE.Vector3(-ahead.z, 0, ahead.x), x)
    const { obstacles, speed } = this.viewer.movement, { head, feet } = this
    this.rig.position.add(walked(obstacles, feet, way.multiplyScalar(speed * seconds), bodyOf(head.y - feet.y, true)).sub(feet))
    this.rig.updateMatrixWorld(true)
  }

  private turnOrAim(source: XRInputSource, x: number, y: number): void {
    if (Math.abs(x) > PUSHED && !this.turned) {
      // About the head, not about the middle of the room in which one plays.
      const head = this.head, angle = -Math.sign(x) * SNAP
      this.rig.position.sub(head).applyAxisAngle(new THREE.Vector3(0, 1, 0), angle).add(head)
      this.rig.rotation.y += angle
      this.rig.updateMatrixWorld(true)
      this.turned = true
    } else if (Math.abs(x) < RELEASED) {
      this.turned = false
    }
    if (-y > PUSHED && !this.aiming) {
      this.aiming = source
      this.byStick = true
    } else if (this.byStick && -y < RELEASED) {
      this.land()
    }
  }

  /** Where the controller points at a floor. */
  private point(frame: XRFrame): void {
    this.aim = undefined
    const space = this.viewer.stage.renderer.xr.getReferenceSpace()
    const pose = this.aiming && space ? frame.getPose(this.aiming.targetRaySpace, space) : undefined
    this.ray.visible = this.ring.visible = false
    if (!pose) return
    const matrix = new THREE.Matrix4().fromArray(pose.transform.matrix as unknown as number[]).premultiply(this.rig.matrixWorld)
    const from = new THREE.Vector3().setFromMatrixPosition(matrix)
    const way = new THREE.Vector3(0, 0, -1).transformDirection(matrix)
    const place = this.viewer.placeAlong(new THREE.Ray(from, way))
    const to = place ? this.viewer.toPage(place.point) : from.clone().addScaledVector(way, 20)
    if (place && this.viewer.toPage(place.normal).y > 0.7) this.aim = to
    this.ray.geometry.dispose()
    this.ray.geometry = new THREE.BufferGeometry().setFromPoints([from, to])
    this.ray.visible = true
    this.ring.visible = this.aim !== undefined
    if (this.aim) this.ring.position.copy(this.aim).y += 0.01
  }

  private land(): void {
    if (this.aim) {
      const { x, z } = this.head
      this.rig.position.add(new THREE.Vector3(this.aim.x - x, 0, this.aim.z - z))
      this.rig.position.y = this.aim.y
    }
    this.aiming = undefined
    this.byStick = false
  }

  private keepOnGround(seconds: number): void {
    const head = this.head, ground = this.viewer.movement.feel(head, new THREE.Vector3(0, -1, 0))
    if (ground === undefined) return
    const gap = head.y - ground - this.rig.position.y
    if (gap > bodyOf(head.y - this.rig.position.y, true).knees) return  // leant over a table, say
    this.rig.position.y += Math.sign(gap) * Math.min(Math.abs(gap), 3 * seconds)
  }
}
