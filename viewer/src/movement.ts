// SPDX-License-Identifier: Apache-2.0
// How one moves: in orbit around a point, with the keys of `radview`, or on foot. Mouse, touch,
// keys and gamepad change one pose; flights change it smoothly.

import * as THREE from 'three'
import { FlightPath } from './flight_path'
import { between, copyOf, lineOfSight, moved, orbited, type Pose, poseLooking, reference, turned, zoomed } from './pose'
import { bodyOf, type Obstacles, walked } from './walker'

export type Mode = 'orbit' | 'walk'
const DEGREE = Math.PI / 180
const DOUBLE = 350  // ms from a tap to the second
const ARROWS: Record<string, [number, number]> = {
  ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1],
}
const WALK_KEYS = ['KeyW', 'KeyA', 'KeyS', 'KeyD', 'KeyQ', 'KeyE', 'Space', 'ShiftLeft', 'ShiftRight']

/** How far it is to the next surface from `from` along `direction`, or nothing. */
export type Feeler = (from: THREE.Vector3, direction: THREE.Vector3) => number | undefined

export class Movement extends EventTarget {
  mode: Mode = 'orbit'
  gravity = true
  automatic = false
  /** The places that automatic mode flies through; fewer than two: it turns slowly instead. */
  stops: () => Pose[] = () => []
  /** Metres per second on foot, and how high the eyes are. */
  speed = 1.4
  eyeHeight = 1.6
  feel: Feeler = () => undefined
  obstacles: Obstacles = () => {}
  /** Whether somebody takes a tap for something else than moving. */
  takesTap: (x: number, y: number) => boolean = () => false
  /** A tap that no second one follows. */
  onTap: (x: number, y: number) => void = () => {}
  onDoubleTap: (x: number, y: number) => void = () => {}
  onMenu: (x: number, y: number) => void = () => {}
  private home: Pose
  private flight?: { from: Pose; to: Pose; start: number; seconds: number }
  private path?: FlightPath
  private onPath = 0  // seconds since its start
  private held = new Set<string>()
  private pointers = new Map<number, { x: number; y: number }>()
  private travelled = 0
  private lastTap = { time: -1e9, x: 0, y: 0 }
  private tapped = 0
  private fallSpeed = 0

  constructor(private canvas: HTMLElement, public pose: Pose) {
    super()
    this.home = copyOf(pose)
    canvas.addEventListener('pointerdown', (e) => this.down(e))
    canvas.addEventListener('pointermove', (e) => this.move(e))
    canvas.addEventListener('pointerup', (e) => this.up(e))
    canvas.addEventListener('pointercancel', (e) => this.pointers.delete(e.pointerId))
    canvas.addEventListener('wheel', (e) => this.wheel(e), { passive: false })
    canvas.addEventListener('keydown', (e) => this.keyDown(e))
    canvas.addEventListener('keyup', (e) => this.held.delete(e.code))
    canvas.addEventListener('blur', () => this.held.clear())
    canvas.addEventListener('contextmenu', (e) => {
      e.preventDefault()
      if ((e as PointerEvent).pointerType === 'touch' && this.travelled <= 5) this.onMenu(e.clientX, e.clientY)
    })
    document.addEventListener('pointerlockchange', () => this.told())
  }

  private told(): void {
    this.dispatchEvent(new Event('change'))
  }
  private set(pose: Pose): void {
    this.flight = undefined
    this.automatic = false
    this.pose = pose
    this.told()
  }

  setHome(pose: Pose): void {
    this.home = copyOf(pose)
  }
  setMode(mode: Mode): void {
    this.mode = mode
    this.held.clear()
    if (mode === 'orbit' && document.pointerLockElement) document.exitPointerLock()
    this.told()
  }
  flyTo(to: Pose, seconds = 0.9): void {
    this.automatic = false
    if (matchMedia('(prefers-reduced-motion: reduce)').matches) seconds = 0
    this.flight = { from: copyOf(this.pose), to: copyOf(to), start: performance.now(), seconds }
    this.told()
  }
  /** Flies through the places, or turns; whoever moves by hand ends that. */
  setAutomatic(on: boolean): void {
    const stops = on ? this.stops() : []
    this.path = stops.length > 1 ? new FlightPath(stops, this.speed) : undefined
    this.onPath = 0
    if (this.path) this.flyTo(this.path.start, 2)
    this.automatic = on
    this.told()
  }
  get flying(): boolean {
    return this.flight !== undefined
  }
  reset(): void {
    this.flyTo(this.home)
  }
  /** Goes where a surface was pointed at: on foot to stand there, in orbit to turn about it. */
  goTo(point: THREE.Vector3, normal: THREE.Vector3): void {
    const way = point.clone().sub(this.pose.eye), distance = way.length()
    const to = copyOf(this.pose)
    if (this.mode === 'walk' && normal.y > 0.7) {
      to.eye = point.clone().add(new THREE.Vector3(0, this.eyeHeight, 0))
    } else {
      to.eye.addScaledVector(way, 0.6)
      to.distance = 0.4 * distance
      to.azimuth = Math.atan2(-way.x, -way.z)
      to.elevation = Math.asin(Math.min(1, Math.max(-1, way.y / Math.max(distance, 1e-9))))
    }
    this.flyTo(to)
  }

  /** Turns to a place and, in orbit, from now on about it. */
  lookAt(point: THREE.Vector3): void {
    this.flyTo(poseLooking(this.pose.eye, point, this.pose.fov), 0.5)
  }

  // Pointers -----------------------------------------------------------------------------------

  private down(event: PointerEvent): void {
    this.canvas.focus({ preventScroll: true })
    if (this.pointers.size === 0) this.travelled = 0
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY })
    try {
      this.canvas.setPointerCapture(event.pointerId)
    } catch { /* a pointer that a test made up */ }
  }

  private move(event: PointerEvent): void {
    if (document.pointerLockElement === this.canvas) {
      this.look(event.movementX, event.movementY)
      return
    }
    const last = this.pointers.get(event.pointerId)
    if (!last) return
    const dx = event.clientX - last.x, dy = event.clientY - last.y
    this.travelled += Math.abs(dx) + Math.abs(dy)
    if (this.pointers.size === 2) this.pinch(event, dx, dy)
    else if (event.buttons & 2 || event.buttons & 4) this.slide(dx, dy)
    else this.look(dx, dy)
    last.x = event.clientX
    last.y = event.clientY
  }

  /** A drag over the whole height turns by the field of view on foot, by half a circle in orbit. */
  private look(dx: number, dy: number): void {
    const height = this.canvas.clientHeight || 1
    if (this.mode === 'walk') {
      const scale = this.pose.fov * DEGREE / height * 1.4
      const sign = document.pointerLockElement === this.canvas ? -1 : 1
      this.set(turned(this.pose, sign * dx * scale, sign * dy * scale))
    } else {
      this.set(orbited(this.pose, -dx * Math.PI / height, -dy * Math.PI / height))
    }
  }
  private slide(dx: number, dy: number): void {
    const scale = 2 * Math.tan(this.pose.fov * DEGREE / 2) * this.pose.distance / (this.canvas.clientHeight || 1)
    const right = new THREE.Vector3(Math.cos(this.pose.azimuth), 0, -Math.sin(this.pose.azimuth))
    const upwards = right.clone().cross(lineOfSight(this.pose))
    this.set(moved(this.pose, right.multiplyScalar(-dx * scale).addScaledVector(upwards, dy * scale)))
  }
  private pinch(event: PointerEvent, dx: number, dy: number): void {
    const [a, b] = [...this.pointers.values()]
    const other = this.pointers.get(event.pointerId) === a ? b : a
    const before = Math.hypot(event.clientX - dx - other.x, event.clientY - dy - other.y)
    const after = Math.hypot(event.clientX - other.x, event.clientY - other.y)
    this.slide(dx / 2, dy / 2)
    this.advance(before / Math.max(after, 1))
  }
  private advance(factor: number): void {
    if (this.mode === 'orbit') this.set(zoomed(this.pose, factor))
    else this.walkBy(lineOfSight(this.pose), Math.log(1 / factor) * this.speed * 2)
  }
  private wheel(event: WheelEvent): void {
    event.preventDefault()
    const lines = event.deltaMode === 1 ? 16 : 1
    this.advance(Math.exp(event.deltaY * lines * 0.001))
  }

  private up(event: PointerEvent): void {
    if (!this.pointers.delete(event.pointerId) || this.travelled > 5) return
    if (event.button === 2) this.onMenu(event.clientX, event.clientY)
    if (event.button > 0 || this.takesTap(event.clientX, event.clientY)) return
    const now = event.timeStamp
    const near = Math.hypot(event.clientX - this.lastTap.x, event.clientY - this.lastTap.y) < 20
    if (now - this.lastTap.time < DOUBLE && near) {
      this.lastTap.time = -1e9
      clearTimeout(this.tapped)
      this.onDoubleTap(event.clientX, event.clientY)
    } else {
      this.lastTap = { time: now, x: event.clientX, y: event.clientY }
      clearTimeout(this.tapped)
      this.tapped = window.setTimeout(() => this.onTap(event.clientX, event.clientY), DOUBLE)
    }
  }

  /** Looks around without a button held, until Esc. */
  async lockPointer(): Promise<void> {
    this.setMode('walk')
    this.canvas.focus()
    await this.canvas.requestPointerLock()
  }

  // Keys ---------------------------------------------------------------------------------------

  private keyDown(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return
    const arrow = ARROWS[event.key]
    if (arrow) {
      const turn = this.mode === 'walk' ? turned : orbited
      const sign = this.mode === 'walk' ? 1 : -1
      this.set(turn(this.pose, sign * arrow[0] * DEGREE, arrow[1] * DEGREE * sign))
    } else if (this.mode === 'walk' && WALK_KEYS.includes(event.code)) {
      this.flight = undefined
      this.held.add(event.code)
    } else if (this.mode === 'orbit' && 'zxas'.includes(event.key) && event.key.length === 1) {
      this.radview(event.key)
    } else if (event.key === 'r') {
      this.reset()
    } else if (event.key === 'ContextMenu' || (event.key === 'F10' && event.shiftKey)) {
      this.onMenu(this.canvas.clientWidth / 2, this.canvas.clientHeight / 2)
    } else {
      return
    }
    event.preventDefault()
    this.told()
  }

  /** z and x zoom in and out; a and s move viewpoint and reference along and against the sight. */
  private radview(key: string): void {
    const step = 0.05 * this.pose.distance
    if (key === 'z') this.set(zoomed(this.pose, 0.95))
    if (key === 'x') this.set(zoomed(this.pose, 1 / 0.95))
    if (key === 'a') this.set(moved(this.pose, lineOfSight(this.pose).multiplyScalar(step)))
    if (key === 's') this.set(moved(this.pose, lineOfSight(this.pose).multiplyScalar(-step)))
  }

  // Time ---------------------------------------------------------------------------------------

  /** Moves on by `seconds`; whether there is more to come without anybody's doing. */
  advanceTime(seconds: number): boolean {
    if (this.flight) {
      const { from, to, start, seconds: length } = this.flight
      const t = length > 0 ? Math.min(1, (performance.now() - start) / (1000 * length)) : 1
      this.pose = between(from, to, t)
      if (t >= 1) this.flight = undefined
      this.told()
      return true
    }
    const stick = this.gamepad(seconds)
    if (this.automatic && this.path) this.flyOn(seconds)
    else if (this.automatic) this.circle(seconds)
    const walked = this.mode === 'walk' && !this.automatic && this.walk(seconds)
    return stick || this.automatic || walked
  }

  private flyOn(seconds: number): void {
    this.onPath += seconds
    this.pose = this.path!.at(this.onPath)
    this.told()
  }

  /** Once around in forty seconds. */
  private circle(seconds: number): void {
    const step = 2 * Math.PI / 40 * seconds
    this.pose = this.mode === 'walk' ? turned(this.pose, step, 0) : orbited(this.pose, step, 0)
    this.told()
  }

  private walk(seconds: number): boolean {
    const on = (...codes: string[]) => (codes.some((code) => this.held.has(code)) ? 1 : 0)
    const ahead = on('KeyW') - on('KeyS'), right = on('KeyD') - on('KeyA')
    const rise = on('KeyE', 'Space') - on('KeyQ')
    const pace = this.speed * (on('ShiftLeft', 'ShiftRight') ? 3 : 1) * seconds
    const { azimuth } = this.pose
    const way = new THREE.Vector3(-Math.sin(azimuth), 0, -Math.cos(azimuth)).multiplyScalar(ahead)
      .add(new THREE.Vector3(Math.cos(azimuth), 0, -Math.sin(azimuth)).multiplyScalar(right))
    if (!this.gravity) way.y += rise + ahead * Math.sin(this.pose.elevation)
    if (way.lengthSq() > 0) this.walkBy(way.normalize(), pace)
    const fell = this.gravity && this.fall(seconds)
    return way.lengthSq() > 0 || fell
  }

  /** A step along `direction`: on foot along what is in the way, up and down what is low. */
  private walkBy(direction: THREE.Vector3, length: number): void {
    const step = direction.clone().multiplyScalar(length)
    if (this.mode === 'walk') this.set(moved(this.pose, this.stepFrom(this.pose.eye, step)))
    else this.set(moved(this.pose, step))
  }

  /** How far the eyes come of a step that is wanted. */
  private stepFrom(eye: THREE.Vector3, step: THREE.Vector3): THREE.Vector3 {
    const feet = eye.clone().setY(eye.y - this.eyeHeight), level = step.clone().setY(0)
    return walked(this.obstacles, feet, level, bodyOf(this.eyeHeight, this.gravity)).sub(feet)
      .setY(this.gravity ? 0 : this.risen(eye, step.y))
  }
  /** Up to a ceiling, down to a floor, a berth away. */
  private risen(eye: THREE.Vector3, by: number): number {
    if (by === 0) return 0
    const free = this.feel(eye, new THREE.Vector3(0, Math.sign(by), 0)) ?? Infinity
    return Math.sign(by) * Math.max(0, Math.min(Math.abs(by), free - 0.15 * this.eyeHeight))
  }

  /** The eyes stay so high above what is below them. */
  private fall(seconds: number): boolean {
    const ground = this.feel(this.pose.eye, new THREE.Vector3(0, -1, 0))
    if (ground === undefined) return false
    const gap = ground - this.eyeHeight
    if (Math.abs(gap) < 1e-3 * this.eyeHeight) {
      this.fallSpeed = 0
      return false
    }
    this.fallSpeed += 9.81 * seconds * this.eyeHeight / 1.6
    const by = gap > 0 ? Math.min(gap, this.fallSpeed * seconds) : Math.max(gap, -4 * this.eyeHeight * seconds)
    this.pose = moved(this.pose, new THREE.Vector3(0, -by, 0))
    this.told()
    return true
  }

  /** Left stick walks, right stick looks, triggers rise and sink. */
  private gamepad(seconds: number): boolean {
    const pad = navigator.getGamepads?.().find((p) => p?.connected)
    if (!pad) return false
    const axis = (k: number) => (Math.abs(pad.axes[k] ?? 0) > 0.15 ? pad.axes[k] : 0)
    const [x, y, u, v] = [axis(0), axis(1), axis(2), axis(3)]
    if (!x && !y && !u && !v) return false
    this.set((this.mode === 'walk' ? turned : orbited)(this.pose, -u * 2 * seconds, -v * 1.5 * seconds))
    const { azimuth } = this.pose
    this.walkBy(new THREE.Vector3(-Math.sin(azimuth), 0, -Math.cos(azimuth)), -y * this.speed * seconds)
    this.walkBy(new THREE.Vector3(Math.cos(azimuth), 0, -Math.sin(azimuth)), x * this.speed * seconds)
    return true
  }

  get target(): THREE.Vector3 {
    return reference(this.pose)
  }
}
