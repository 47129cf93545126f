// SPDX-License-Identifier: Apache-2.0
// Sensor grids: each a plane in false colours with its numbers, and min, mean and uniformity.
// The readings of each light group come from the program once; the mix is summed here.

import * as THREE from 'three'
import { falseColour } from './false_colour'
import type { FloatingLabels } from './floating_labels'
import { figures } from './numbers'
import type { SensorGrid } from './solution'
import { luminance } from './tone'
import type { Viewer } from './viewer'

export interface GridFigures { name: string; min: number; mean: number; max: number; uniformity: number }
type Readings = (number[] | null)[]

const MOST_NUMBERS = 400

/** Where sensor (i, j) lies, in the scene's frame; continuous, so that 0 ... columns is the plane. */
function pointOf(grid: SensorGrid, i: number, j: number): THREE.Vector3 {
  return new THREE.Vector3(...grid.origin)
    .addScaledVector(new THREE.Vector3(...grid.u), i / grid.columns)
    .addScaledVector(new THREE.Vector3(...grid.v), j / grid.rows)
}

export class SensorGrids extends EventTarget {
  figures: GridFigures[] = []
  private shown = false
  private readings?: Readings
  private planes = new THREE.Group()

  constructor(private viewer: Viewer, private labels: FloatingLabels) {
    super()
    viewer.stage.overlay.add(this.planes)
    viewer.addEventListener('settings', () => this.refresh())
    viewer.addEventListener('solution', () => {
      this.readings = undefined
      if (this.shown) void this.show(true)
    })
  }

  async show(shown: boolean): Promise<void> {
    this.shown = shown
    if (shown && !this.readings) {
      const inside = document.getElementById('grids')
      this.readings = JSON.parse(inside ? inside.textContent! : await (await fetch('grids.json')).text()) as Readings
    }
    this.refresh()
    this.viewer.changed()
  }

  /** Illuminance of every sensor of a grid as the lights are mixed now. */
  private values(grid: SensorGrid, readings: number[]): Float64Array {
    const factors = this.viewer.mix.factors(performance.now()), groups = factors.length / 3
    const out = new Float64Array(grid.columns * grid.rows)
    for (let k = 0; k < out.length; ++k)
      for (let g = 0; g < groups; ++g) {
        const at = 3 * (k * groups + g)
        out[k] += luminance(factors[3 * g] * readings[at], factors[3 * g + 1] * readings[at + 1], factors[3 * g + 2] * readings[at + 2])
      }
    return out
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
    // A little off the surface that it may lie on.
    const off = new THREE.Vector3(...grid.normal).normalize().multiplyScalar(2e-3 * this.viewer.box.getSize(new THREE.Vector3()).length())
    const geometry = new THREE.BufferGeometry().setFromPoints(corners.map(([i, j]) => this.viewer.toPage(pointOf(grid, i, j).add(off))))
    geometry.setAttribute('uv', new THREE.Float32BufferAttribute([0, 0, 1, 0, 1, 1, 0, 1], 2))
    geometry.setIndex([0, 1, 2, 0, 2, 3])
    return new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ map, side: THREE.DoubleSide, toneMapped: false }))
  }
}
