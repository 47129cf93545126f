// SPDX-License-Identifier: Apache-2.0
// The state of the walkthrough: one solution, one mix of its lights, one pose, one look. Panels
// and keys change it; it draws when something changed.

import * as THREE from 'three'
import { automaticView } from './automatic_view'
import { LightMix } from './light_mix'
import { Movement } from './movement'
import { pick, type Place, read, type Reading, trianglesWithin } from './picking'
import { copyOf, type Pose, poseLooking, poseOfCamera, reference, turnOfUp } from './pose'
import type { SensorReading } from './sensor_grids'
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
  most = 1                     // that fits: what 99 % of the surfaces stay below
  contour = 0                  // step, 0 = none
  wires = false
  section = { axis: -1, at: 0.5, flipped: false }  // axis 0, 1, 2 of the page; at: 0 ... 1 of the box
  /** The nearest shown sensor that a ray of the page's frame meets. */
  sensors: (ray: THREE.Ray) => SensorReading | null = () => null
  pointer?: { x: number; y: number }
  readonly bookmarks: { eye: number[]; look_at: number[]; fov: number }[] = []
  /** Called before each frame that a headset shows. */
  inHeadset: (seconds: number, frame: XRFrame) => void = () => {}

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
    this.movement.obstacles = (box, each) => trianglesWithin(this.stage.mesh, box, each)
    this.movement.onDoubleTap = (x, y) => {
      const place = this.pickAt(x, y)
      if (place) this.movement.goTo(this.toPage(place.point), place.normal.clone().applyQuaternion(this.turn))
    }
    this.movement.stops = () => this.places
    this.movement.addEventListener('change', () => this.changed())
    canvas.addEventListener('pointermove', (e) => this.hover({ x: e.clientX, y: e.clientY }))
    // A finger that is lifted has pointed at what it left.
    canvas.addEventListener('pointerdown', (e) => this.hover({ x: e.clientX, y: e.clientY }))
    canvas.addEventListener('pointerleave', (e) => e.pointerType !== 'touch' && this.hover(undefined))
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
    this.stage.mesh.showWires(this.wires, this.stage.cut)
    this.lightChanged()
    this.dispatchEvent(new Event('solution'))
    if (first) this.stage.renderer.setAnimationLoop((now, frame) => this.frame(now, frame))
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
  /** Keeps where one is for later. */
  keepPlace(): void {
    this.bookmarks.push(this.place())
    this.dispatchEvent(new Event('bookmarks'))
  }
  /** The scene's cameras and what was kept. */
  get places(): Pose[] {
    return [...this.solution.cameras.map((camera) => poseOfCamera(camera, this.turn)),
      ...this.bookmarks.map(({ eye, look_at, fov }) => this.poseAt(eye, look_at, fov))]
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
    this.look = look === 'unshot' && !this.solution.unshot ? 'picture' : look
    this.stage.setLook(this.look, this.contour > 0)
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
  get inFalseColour(): boolean {
    return ['illuminance', 'exitance', 'unshot'].includes(this.look)
  }
  /** What false colours show. */
  get quantity(): { name: string; unit: string } {
    const { quantity, unit } = this.solution, photometric = quantity === 'photometric'
    if (this.look === 'exitance') return { name: 'Exitance', unit }
    if (this.look === 'unshot') return { name: 'Unshot exitance', unit }
    return { name: photometric ? 'Illuminance' : 'Irradiance', unit: photometric ? 'lx' : unit }
  }
  fitRange(): void {
    this.most = this.mostOfSurfaces()
    this.range = { automatic: true, low: 0, high: this.most }
    this.stage.uniforms.range.value.set(0, this.range.high)
    this.told()
  }
  setContour(step: number): void {
    this.contour = step
    this.stage.uniforms.contour.value = step
    this.stage.setLook(this.look, step > 0)
    this.told()
  }
  setWires(shown: boolean): void {
    this.wires = shown
    this.stage.mesh.showWires(shown, this.stage.cut)
    this.told()
  }
  setSection(change: Partial<Viewer['section']>): void {
    Object.assign(this.section, change)
    const { axis, at, flipped } = this.section, plane = new THREE.Vector4(0, 0, 0, 0)
    if (axis >= 0) {
      const low = this.box.min.getComponent(axis), high = this.box.max.getComponent(axis)
      const sign = flipped ? -1 : 1
      plane.setComponent(axis, sign)
      plane.w = sign * (low + (high - low) * at)
    }
    this.stage.setSection(plane)
    this.told()
  }

  /** What 99 % of the area that does not shine itself stays below, rounded up. */
  private mostOfSurfaces(): number {
    const { solution } = this, { positions, indices, unshot } = solution, factors = this.mix.factors(performance.now())
    const columns = this.look === 'exitance' ? solution.exitance : solution.irradiance
    const level = this.look === 'unshot' && unshot ? (v: number) => unshot[v]
      : (v: number) => columns.reduce((sum, of, g) =>
        sum + luminance(factors[3 * g] * of[3 * v], factors[3 * g + 1] * of[3 * v + 1], factors[3 * g + 2] * of[3 * v + 2]), 0)
    const seen: { value: number; area: number }[] = [], step = Math.max(1, Math.floor(indices.length / 3 / 20000))
    const corner = (i: number) => new THREE.Vector3().fromArray(positions, 3 * indices[i])
    for (const p of solution.primitives) {
      if (solution.materials[p.material].exitance.some((e) => e > 0)) continue
      for (let t = p.firstTriangle; t < p.firstTriangle + p.triangles; t += step)
        seen.push({ value: level(indices[3 * t]), area: new THREE.Triangle(corner(3 * t), corner(3 * t + 1), corner(3 * t + 2)).getArea() })
    }
    seen.sort((a, b) => a.value - b.value)
    const all = seen.reduce((sum, s) => sum + s.area, 0)
    let below = 0
    const high = seen.find((s) => (below += s.area) >= 0.99 * all)?.value || 1
    const round = 10 ** Math.floor(Math.log10(high)) / 2
    return Math.ceil(high / round) * round
  }

  // What is under the pointer ----------------------------------------------------------------------

  private pickRay(ray: THREE.Ray, sectioned = true): Place | null {
    return pick(this.stage.mesh, this.solution, ray, sectioned ? this.stage.uniforms.section.value : undefined)
  }
  // `x`, `y`: CSS pixels of the canvas.

  /** In orbit: turns to what lies under a place of the canvas and from now on about it. */
  lookAt(x: number, y: number): void {
    const point = this.movement.mode === 'orbit' ? this.touchAt(x, y) : null
    if (point) this.movement.lookAt(point)
  }
  /** In the page's frame, nothing beyond the section. */
  placeAlong(ray: THREE.Ray): Place | null {
    return this.solution ? this.pickRay(ray) : null
  }
  pickAt(x: number, y: number): Place | null {
    return this.solution ? this.pickRay(this.stage.ray(this.pose, x, y)) : null
  }
  readAt(x: number, y: number): Reading | null {
    const place = this.pickAt(x, y)
    return place && read(this.solution, place, this.mix.factors(performance.now()))
  }
  /** What is seen at a place of the canvas, be it a surface or a plane of sensors: where, in the page's frame. */
  touchAt(x: number, y: number): THREE.Vector3 | null {
    const place = this.pickAt(x, y)
    return this.sensorAt(x, y)?.point ?? (place && this.toPage(place.point))
  }
  /** The sensor that is seen at a place of the canvas, no surface before it. */
  sensorAt(x: number, y: number): SensorReading | null {
    if (!this.solution) return null
    const ray = this.stage.ray(this.pose, x, y), sensor = this.sensors(ray), hit = sensor && this.pickRay(ray)
    return sensor && !(hit && hit.distance < sensor.distance) ? sensor : null
  }
  /** Whether the section cuts a place of the page's frame away. */
  isCut(at: THREE.Vector3): boolean {
    return this.stage.cut.some((plane) => plane.distanceToPoint(at) < 0)
  }
  /** Whether a surface stands between the eye and a place of the page's frame, or the section cuts it away. */
  isHidden(at: THREE.Vector3): boolean {
    if (this.isCut(at)) return true
    const way = at.clone().sub(this.pose.eye), distance = way.length()
    const hit = this.pickRay(new THREE.Ray(this.pose.eye, way.divideScalar(distance)))
    return hit !== null && hit.distance < 0.98 * distance
  }
  private hover(at: Viewer['pointer']): void {
    this.pointer = at
    this.dispatchEvent(new Event('pointer'))
  }

  // Frames -----------------------------------------------------------------------------------------

  private frame(now: number, frame?: XRFrame): void {
    const seconds = Math.min(0.1, Math.max(0, now - this.lastFrame) / 1000)
    this.lastFrame = now
    if (frame) this.inHeadset(seconds, frame)
    else if (this.movement.advanceTime(seconds)) this.dirty = true
    if (this.mix.fading) {
      this.stage.mesh.setFactors(this.mix.factors(now))
      this.changed()
      if (!this.mix.fading) this.lightChanged()
    }
    if (this.stage.resize()) this.changed()
    if (this.meterAt && now >= this.meterAt && !frame) this.meter()
    const gap = Math.log(this.exposureWanted / this.exposure)
    if (Math.abs(gap) > 0.002) {
      this.exposure *= Math.exp(gap * Math.min(1, 8 * seconds))
      this.dirty = true
    } else {
      this.exposure = this.exposureWanted
    }
    if (!this.dirty && !frame) return
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

  picture(width: number, height: number, done: (share: number) => void = () => {}): Promise<Blob> {
    return this.stage.picture(copyOf(this.pose), width, height, (share) => {
      this.draw()
      done(share)
    })
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
