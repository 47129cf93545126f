// SPDX-License-Identifier: Apache-2.0
// Sensor grids: each a plane in false colours with its numbers, and min, mean and uniformity.
// The readings of each light group come from the program once; the mix is summed here.

import * as THREE from 'three'
import { falseColour } from './false_colour'
import type { FloatingLabels } from './floating_labels'
import { notifyError } from './notice'
import { figures } from './numbers'
import { ask } from './program'
import type { SensorGrid } from './solution'
import { luminance } from './tone'
import type { Viewer } from './viewer'

export interface GridFigures { name: string; min: number; mean: number; max: number; uniformity: number }
/** What a sensor reads as the lights are mixed. */
export interface SensorReading {
  grid: string
  column: number               // from 1
  row: number
  illuminance: number
  shares: number[]             // of it, per group, 0 ... 1
  point: THREE.Vector3         // of its plane, in the page's frame
  distance: number
}
type Readings = (number[] | null)[]

const MOST_NUMBERS = 400
const sum = (values: number[]) => values.reduce((a, b) => a + b, 0)

/** Where sensor (i, j) lies, in the scene's frame; continuous, so that 0 ... columns is the plane. */
function pointOf(grid: SensorGrid, i: number, j: number): THREE.Vector3 {
  return new THREE.Vector3(...grid.origin)
    .addScaledVector(new THREE.Vector3(...grid.u), i / grid.columns)
    .addScaledVector(new THREE.Vector3(...grid.v), j / grid.rows)
}

export class SensorGrids extends EventTarget {
  figures: GridFigures[] = []
  /** Whether they are asked for; what they read may still be on its way. */
  wanted = false
  private shown = false
  private readings?: Readings
  private planes = new THREE.Group()

  constructor(private viewer: Viewer, private labels: FloatingLabels) {
    super()
    viewer.stage.overlay.add(this.planes)
    viewer.sensors = (ray) => this.met(ray)
    viewer.addEventListener('settings', () => this.refresh())
    viewer.addEventListener('solution', () => {
      this.readings = undefined
      if (this.wanted) this.show(true).catch(notifyError)
    })
  }

  async show(shown: boolean): Promise<void> {
    this.wanted = shown
    try {
      if (shown) this.readings ??= await this.askForReadings()
    } catch (error) {
      this.wanted = false
      throw error
    } finally {
      this.shown = this.wanted
      this.refresh()
      this.viewer.changed()
    }
  }

  private async askForReadings(): Promise<Readings> {
    const inside = document.getElementById('grids')
    return JSON.parse(inside ? inside.textContent! : new TextDecoder().decode((await ask('grids.json')).bytes)) as Readings
  }

  /** Illuminance of sensor `k` by each group, as the lights are mixed now. */
  private byGroup(readings: number[], k: number, factors: number[]): number[] {
    const groups = factors.length / 3
    return Array.from({ length: groups }, (_, g) => {
      const [r, green, b] = [0, 1, 2].map((c) => factors[3 * g + c] * readings[3 * (k * groups + g) + c])
      return luminance(r, green, b)
    })
  }
  private values(grid: SensorGrid, readings: number[]): Float64Array {
    const factors = this.viewer.mix.factors(performance.now())
    return Float64Array.from({ length: grid.columns * grid.rows }, (_, k) => sum(this.byGroup(readings, k, factors)))
  }

  /** The nearest sensor that a ray meets. */
  private met(ray: THREE.Ray): SensorReading | null {
    const found = !this.shown ? [] : this.viewer.solution.grids.flatMap((grid, i) => {
      const readings = this.readings?.[i], across = readings && this.across(grid, ray)
      if (!across) return []
      const [column, row] = [Math.floor(across.i), Math.floor(across.j)]
      const lux = this.byGroup(readings, row * grid.columns + column, this.viewer.mix.factors(performance.now())), all = sum(lux)
      return [{ grid: grid.name, column: column + 1, row: row + 1, illuminance: all, shares: lux.map((v) => (all > 0 ? v / all : 0)),
        point: across.point, distance: across.point.distanceTo(ray.origin) }]
    })
    return found.sort((a, b) => a.distance - b.distance)[0] ?? null
  }

  /** Where a ray crosses the plane of a grid, in sensors, unless the section cuts it away there. */
  private across(grid: SensorGrid, ray: THREE.Ray): { i: number; j: number; point: THREE.Vector3 } | null {
    const [a, b, c] = [[0, 0], [grid.columns, 0], [0, grid.rows]].map(([i, j]) => this.onPlane(grid, i, j))
    const u = b.sub(a), v = c.sub(a), normal = u.clone().cross(v), area = normal.lengthSq()
    const distance = a.clone().sub(ray.origin).dot(normal) / ray.direction.dot(normal)
    if (!(distance > 0)) return null
    const point = ray.at(distance, new THREE.Vector3()), way = point.clone().sub(a)
    const s = way.clone().cross(v).dot(normal) / area, t = u.clone().cross(way).dot(normal) / area
    return s >= 0 && s < 1 && t >= 0 && t < 1 && !this.viewer.isCut(point) ? { i: s * grid.columns, j: t * grid.rows, point } : null
  }

  /** Where the plane is drawn, in the page's frame: a little off the surface that it may lie on. */
  private onPlane(grid: SensorGrid, i: number, j: number): THREE.Vector3 {
    const off = 2e-3 * this.viewer.box.getSize(new THREE.Vector3()).length()
    return this.viewer.toPage(pointOf(grid, i, j).addScaledVector(new THREE.Vector3(...grid.normal).normalize(), off))
  }

  private refresh(): void {
    for (const child of [...this.planes.children] as THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>[]) {
      child.geometry.dispose()
      child.material.map?.dispose()
      child.material.dispose()
      this.planes.remove(child)
    }
    const texts: { at: THREE.Vector3; text: string; small: boolean }[] = []
    this.figures = []
    if (this.shown && this.readings)
      this.viewer.solution.grids.forEach((grid, i) => {
        const readings = this.readings![i]
        if (readings) this.add(grid, this.values(grid, readings), texts)
      })
    this.labels.set('grids', texts)
    this.dispatchEvent(new Event('change'))
  }

  private add(grid: SensorGrid, values: Float64Array, texts: { at: THREE.Vector3; text: string; small: boolean }[]): void {
    const min = values.reduce((a, b) => Math.min(a, b), Infinity), max = values.reduce((a, b) => Math.max(a, b), -Infinity)
    const mean = values.reduce((a, b) => a + b, 0) / values.length
    this.figures.push({ name: grid.name, min, mean, max, uniformity: mean > 0 ? min / mean : 0 })
    this.planes.add(this.plane(grid, values))
    if (values.length > MOST_NUMBERS) return
    for (let j = 0; j < grid.rows; ++j)
      for (let i = 0; i < grid.columns; ++i)
        texts.push({ at: this.viewer.toPage(pointOf(grid, i + 0.5, j + 0.5)), text: figures(values[j * grid.columns + i]), small: true })
  }

  private plane(grid: SensorGrid, values: Float64Array): THREE.Mesh {
    const { low, high } = this.viewer.range, bytes = new Uint8Array(4 * values.length)
    values.forEach((value, k) => {
      falseColour((value - low) / (high - low)).forEach((c, b) => (bytes[4 * k + b] = Math.round(255 * Math.min(1, Math.max(0, c)) ** (1 / 2.2))))
      bytes[4 * k + 3] = 255
    })
    const map = new THREE.DataTexture(bytes, grid.columns, grid.rows)
    map.colorSpace = THREE.SRGBColorSpace
    map.needsUpdate = true
    const corners = [[0, 0], [grid.columns, 0], [grid.columns, grid.rows], [0, grid.rows]]
    const geometry = new THREE.BufferGeometry().setFromPoints(corners.map(([i, j]) => this.onPlane(grid, i, j)))
    geometry.setAttribute('uv', new THREE.Float32BufferAttribute([0, 0, 1, 0, 1, 1, 0, 1], 2))
    geometry.setIndex([0, 1, 2, 0, 2, 3])
    return new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ map, side: THREE.DoubleSide, toneMapped: false,
      clippingPlanes: this.viewer.stage.cut }))
  }
}
