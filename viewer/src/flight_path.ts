// SPDX-License-Identifier: Apache-2.0
// A round trip through places: what the original's automatic mode flies.

import * as THREE from 'three'
import { copyOf, type Pose, poseLooking, reference } from './pose'

const LEAST_SECONDS = 4  // from one place to the next

export class FlightPath {
  private eyes: THREE.CatmullRomCurve3
  private targets: THREE.CatmullRomCurve3
  private ends: number[] = []  // when each leg is over [s]

  /** At least two places; `speed` in metres per second. */
  constructor(private stops: Pose[], speed: number) {
    this.eyes = new THREE.CatmullRomCurve3(stops.map((s) => s.eye.clone()), true)
    this.targets = new THREE.CatmullRomCurve3(stops.map(reference), true)
    let seconds = 0
    stops.forEach((stop, i) => {
      const way = stop.eye.distanceTo(stops[(i + 1) % stops.length].eye)
      this.ends.push(seconds += Math.max(LEAST_SECONDS, way / speed))
    })
  }

  get seconds(): number {
    return this.ends[this.ends.length - 1]
  }
  get start(): Pose {
    return copyOf(this.stops[0])
  }

  at(seconds: number): Pose {
    const now = seconds % this.seconds, leg = this.ends.findIndex((end) => now < end)
    const begin = leg > 0 ? this.ends[leg - 1] : 0, part = (now - begin) / (this.ends[leg] - begin)
    const n = this.stops.length, t = (leg + part) / n
    const from = this.stops[leg].fov, to = this.stops[(leg + 1) % n].fov
    return poseLooking(this.eyes.getPoint(t), this.targets.getPoint(t), from + (to - from) * part)
  }
}
