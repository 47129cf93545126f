// SPDX-License-Identifier: Apache-2.0
// The measuring tape: tap two places, read how far apart they are.

import * as THREE from 'three'
import type { FloatingLabels } from './floating_labels'
import { metres } from './numbers'
import type { Viewer } from './viewer'

export class Tape {
  /** Between the last two places [m]. */
  length?: number
  private on = false
  private from?: THREE.Vector3
  private line = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0xf2b84b, depthTest: false }))

  constructor(private viewer: Viewer, private labels: FloatingLabels) {
    this.line.frustumCulled = false
    this.line.renderOrder = 1
    viewer.stage.overlay.add(this.line)
  }

  setOn(on: boolean): void {
    this.on = on
    this.from = this.length = undefined
    this.draw([])
  }

  /** Whether the tape takes a tap. */
  tap(x: number, y: number): boolean {
    if (!this.on) return false
    const here = this.viewer.touchAt(x, y)
    if (!here) return true
    if (this.from) {
      this.length = this.from.distanceTo(here)
      this.draw([this.from, here])
      this.from = undefined
    } else {
      this.from = here
      this.draw([here])
    }
    return true
  }

  private draw(points: THREE.Vector3[]): void {
    this.line.geometry.dispose()
    this.line.geometry = new THREE.BufferGeometry().setFromPoints(points)
    this.line.visible = points.length === 2
    this.labels.set('tape', points.length === 2
      ? [{ at: points[0].clone().lerp(points[1], 0.5), text: metres(this.length!) }]
      : points.map((at) => ({ at, text: '×' })))
  }
}
