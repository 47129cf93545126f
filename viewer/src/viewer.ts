// SPDX-License-Identifier: Apache-2.0
// The state of the walkthrough: one solution, one mix of its lights, one pose, one look. Panels
// and keys change it; it draws when something changed.

import * as THREE from 'three'
import { automaticView } from './automatic_view'
import { LightMix } from './light_mix'
import { Movement } from './movement'
import { pick, type Place, read, type Reading } from './picking'
import { copyOf, type Pose, poseLooking, poseOfCamera, reference, turnOfUp } from './pose'
import type { Look } from './shading'
import type { Solution } from './solution'
import { Stage } from './stage'
import { evOfExposure, exposureOfEv, luminance, type ToneCurve } from './tone'

export class Viewer extends EventTarget {
  readonly stage: Stage
  readonly movement: Movement
  solution!: Solution
  mix!: LightMix
  turn = new THREE.Quaternion()

  look: Look = 'picture'
  automaticExposure = true
  ev = 0
  toneCurve: ToneCurve = 'reinhard'
  range = { automatic: true, low: 0, high: 1 }
  contour = 0                  // step, 0 = none
  wires = false
  section = { axis: -1, at: 0.5, flipped: false }  // axis 0, 1, 2 of the page; at: 0 ... 1 of the box
  pointer?: { x: number; y: number }

  private dirty = true
  private exposure = 1
  private exposureWanted = 1
  private meterAt = 0          // when to measure the exposure again; 0 = not
  private lastFrame = 0

  constructor(readonly canvas: HTMLCanvasElement) {
    super()
    this.stage = new Stage(canvas)
    this.movement = new Movement(canvas, poseLooking(new THREE.Vector3(0, 0, 1), new THREE.Vector3(), 45))
    this.movement.feel = (from, direction) => this.pickRay(new THREE.Ray(from, direction), false)?.distance
    this.movement.onDoubleTap = (x, y) => {
      const place = this.pickAt(x, y)
      if (place) this.movement.goTo(this.toPage(place.point), place.normal.clone().applyQuaternion(this.turn))
    }
    this.movement.addEventListener('change', () => this.changed())
    canvas.addEventListener('pointermove', (e) => this.hover({ x: e.clientX, y: e.clientY }))
    canvas.addEventListener('pointerleave', () => this.hover(undefined))
    matchMedia('(prefers-color-scheme: light)').addEventListener('change', () => this.changed())
  }

  /** Takes over a solution; what was set stays where it still fits. */
  async show(solution: Solution): Promise<void> {
    const first = !this.solution
    await this.stage.show(solution)
    this.solution = solution
    if (!this.mix?.continueWith(solution)) {
      this.mix = new LightMix(solution)
      this.mix.addEventListener('change', () => this.lightChanged())
    }
    this.turn = turnOfUp(solution.up)
    this.stage.mesh.quaternion.copy(this.turn)
    this.stage.mesh.updateMatrixWorld(true)
    if (first) this.enter()
    this.setLook(this.look)
    this.setToneCurve(this.toneCurve)
    this.stage.mesh.showWires(this.wires)
    this.lightChanged()
    this.dispatchEvent(new Event('solution'))
    if (first) this.stage.renderer.setAnimationLoop((now) => this.frame(now))
  }

  private enter(): void {
    const size = this.box.getSize(new THREE.Vector3()), height = size.y, diagonal = size.length()
    this.movement.eyeHeight = Math.min(1.6, 0.65 * height || 1.6)
    this.movement.speed = diagonal > 3 ? 1.4 : 0.4 * diagonal
    const [camera] = this.solution.cameras
    const pose = camera ? poseOfCamera(camera, this.turn)
      : automaticView(this.stage.mesh.bvh, this.stage.mesh.geometry.boundingBox!, this.turn)
    this.movement.pose = pose
    this.movement.setHome(pose)
  }

  /** Of the solution, in the page's frame. */
  get box(): THREE.Box3 {
    return this.stage.mesh.geometry.boundingBox!.clone().applyMatrix4(new THREE.Matrix4().makeRotationFromQuaternion(this.turn))
  }
  get pose(): Pose {
    return this.movement.pose
  }
  toPage(p: THREE.Vector3): THREE.Vector3 {
    return p.clone().applyQuaternion(this.turn)
  }
  toScene(p: THREE.Vector3): THREE.Vector3 {
    return p.clone().applyQuaternion(this.turn.clone().invert())
  }

  // What is set ----------------------------------------------------------------------------------

  /** Draws again; `settings` also tells those who show the settings. */
  changed(): void {
    this.dirty = true
    if (this.automaticExposure || this.toneCurve === 'reinhard') this.meterAt ||= performance.now() + 120
  }
  private told(): void {
    this.changed()
    this.dispatchEvent(new Event('settings'))
  }
  private lightChanged(): void {
    this.stage.mesh.setFactors(this.mix.factors(performance.now()))
    if (this.range.automatic) this.fitRange()
    this.told()
  }
  setLook(look: Look): void {
    this.look = look
    this.stage.setLook(look)
    if (this.range.automatic) this.fitRange()
    this.told()
  }
  setToneCurve(curve: ToneCurve): void {
    this.toneCurve = curve
    this.stage.setToneCurve(curve)
    this.told()
  }
  setExposure(automatic: boolean, ev = this.ev): void {
    this.automaticExposure = automatic
    this.ev = ev
    if (!automatic) this.exposureWanted = this.exposure = exposureOfEv(ev)
    this.told()
  }
  setRange(low: number, high: number): void {
    this.range = { automatic: false, low, high }
    this.stage.uniforms.range.value.set(low, high)
    this.told()
  }
  fitRange(): void {
    this.range = { automatic: true, low: 0, high: this.mostOfSurfaces() }
    this.stage.uniforms.range.value.set(0, this.range.high)
    this.told()
  }
  setContour(step: number): void {
    this.contour = step
    this.stage.uniforms.contour.value = step
    this.told()
  }
  setWires(shown: boolean): void {
    this.wires = shown
    this.stage.mesh.showWires(shown)
    this.told()
  }
  setSection(change: Partial<Viewer['section']>): void {
    Object.assign(this.section, change)
    const { axis, at, flipped } = this.section, plane = this.stage.uniforms.section.value
    plane.set(0, 0, 0, 0)
    if (axis >= 0) {
      const low = this.box.min.getComponent(axis), high = this.box.max.getComponent(axis)
      const sign = flipped ? -1 : 1
      plane.setComponent(axis, sign)
      plane.w = sign * (low + (high - low) * at)
    }
    this.told()
  }

  /** What 99 % of the vertices that do not shine themselves stay below. */
  private mostOfSurfaces(): number {
    const { solution } = this, factors = this.mix.factors(performance.now()), values: number[] = []
    const columns = this.look === 'exitance' ? solution.exitance : solution.irradiance
    const step = Math.max(1, Math.floor(solution.positions.length / 3 / 20000))
    for (const p of solution.primitives) {
      if (solution.materials[p.material].exitance.some((e) => e > 0)) continue
      for (let v = p.firstVertex; v < p.firstVertex + p.vertices; v += step) {
        let sum = 0
        columns.forEach((of, g) => {
          sum += luminance(factors[3 * g] * of[3 * v], factors[3 * g + 1] * of[3 * v + 1], factors[3 * g + 2] * of[3 * v + 2])
        })
        values.push(sum)
      }
    }
    values.sort((a, b) => a - b)
    const high = values[Math.floor(0.99 * (values.length - 1))] || 1
    const round = 10 ** Math.floor(Math.log10(high)) / 2
    return Math.ceil(high / round) * round
  }

  // What is under the pointer ----------------------------------------------------------------------

  private pickRay(ray: THREE.Ray, sectioned = true): Place | null {
    return pick(this.stage.mesh, this.solution, ray, sectioned ? this.stage.uniforms.section.value : undefined)
  }
  /** `x`, `y`: CSS pixels of the canvas. */
  pickAt(x: number, y: number): Place | null {
    return this.solution ? this.pickRay(this.stage.ray(this.pose, x, y)) : null
  }
  readAt(x: number, y: number): Reading | null {
    const place = this.pickAt(x, y)
    return place && read(this.solution, place, this.mix.factors(performance.now()))
  }
  /** Whether a surface stands between the eye and a place of the page's frame. */
  isHidden(at: THREE.Vector3): boolean {
    const way = at.clone().sub(this.pose.eye), distance = way.length()
    const hit = this.pickRay(new THREE.Ray(this.pose.eye, way.divideScalar(distance)))
    return hit !== null && hit.distance < 0.98 * distance
  }
  private hover(at: Viewer['pointer']): void {
    this.pointer = at
    this.dispatchEvent(new Event('pointer'))
  }

  // Frames -----------------------------------------------------------------------------------------

  private frame(now: number): void {
    const seconds = Math.min(0.1, (now - this.lastFrame) / 1000)
    this.lastFrame = now
    if (this.movement.advanceTime(seconds)) this.dirty = true
    if (this.mix.fading) {
      this.stage.mesh.setFactors(this.mix.factors(now))
      this.changed()
      if (!this.mix.fading) this.lightChanged()
    }
    if (this.stage.resize()) this.changed()
    if (this.meterAt && now >= this.meterAt) this.meter()
    const gap = Math.log(this.exposureWanted / this.exposure)
    if (Math.abs(gap) > 0.002) {
      this.exposure *= Math.exp(gap * Math.min(1, 8 * seconds))
      this.dirty = true
    } else {
      this.exposure = this.exposureWanted
    }
    if (!this.dirty && !this.stage.renderer.xr.isPresenting) return
    this.dirty = false
    this.draw()
  }

  private draw(): void {
    const light = matchMedia('(prefers-color-scheme: light)').matches
    this.stage.renderer.setClearColor(light ? 0xd9dbde : 0x0b0c0e)
    this.stage.uniforms.exposure.value = this.exposure
    this.stage.draw(this.pose)
    this.dispatchEvent(new Event('drawn'))
  }

  private meter(): void {
    this.meterAt = 0
    const { exposure, white } = this.stage.expose(this.pose, this.automaticExposure ? undefined : exposureOfEv(this.ev))
    this.exposureWanted = exposure
    this.stage.uniforms.white.value = white
    if (this.automaticExposure) this.ev = evOfExposure(exposure)
    this.dirty = true
    this.dispatchEvent(new Event('exposure'))
  }

  /** Everything that follows by itself has followed, and is drawn. */
  settle(): void {
    this.stage.resize()
    this.stage.mesh.setFactors(this.mix.factors(performance.now()))
    this.meter()
    this.exposure = this.exposureWanted
    this.draw()
  }

  async picture(width: number, height: number): Promise<Blob> {
    const blob = await this.stage.picture(this.pose, width, height)
    this.changed()
    return blob
  }

  /** Where the eye is, in the scene's own axes. */
  place(): { eye: number[]; look_at: number[]; fov: number } {
    const round = (v: THREE.Vector3) => this.toScene(v).toArray().map((x) => Math.round(x * 1e6) / 1e6)
    return { eye: round(this.pose.eye), look_at: round(reference(this.pose)), fov: this.pose.fov }
  }
  poseAt(eye: number[], lookAt: number[], fov: number): Pose {
    return copyOf(poseLooking(this.toPage(new THREE.Vector3(...eye)), this.toPage(new THREE.Vector3(...lookAt)), fov))
  }
}
