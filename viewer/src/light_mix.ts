// SPDX-License-Identifier: Apache-2.0
// How bright, of which colour and whether at all each light group shines. Light is linear: what is
// seen is the sum over the groups of factor x exitance, so nothing is solved again.

import type { Solution } from './solution'

export interface GroupState { weight: number; colour: string; solo: boolean; mute: boolean }

/** Linear RGB of "#rrggbb". */
export function linearOfHex(hex: string): [number, number, number] {
  const value = (at: number) => {
    const v = parseInt(hex.slice(at, at + 2), 16) / 255
    return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4
  }
  return [value(1), value(3), value(5)]
}

export class LightMix extends EventTarget {
  readonly groups: GroupState[]
  /** Of the named scene: index, or -1 for the file's own weights or a mix made by hand. */
  scene = -1
  private shown: number[]  // effective RGB factors now, three per group
  private fade?: { from: number[]; start: number; seconds: number }

  constructor(private solution: Solution) {
    super()
    this.groups = solution.groups.map((g) => ({ weight: g.weight, colour: '#ffffff', solo: false, mute: false }))
    this.shown = this.wanted()
  }

  /** Brightness of each group, 0 for what is muted or not among the soloed. */
  brightness(): number[] {
    const anySolo = this.groups.some((g) => g.solo)
    return this.groups.map((g) => (!g.mute && (!anySolo || g.solo) ? g.weight : 0))
  }

  /** Factors that the states ask for, three per group. */
  private wanted(): number[] {
    const brightness = this.brightness()
    return this.groups.flatMap((g, i) => linearOfHex(g.colour).map((c) => brightness[i] * c))
  }

  /** Factors to show now; while a cross-fade runs they move. */
  factors(now: number): number[] {
    if (this.fade) {
      const t = Math.min(1, (now - this.fade.start) / (1000 * this.fade.seconds))
      const wanted = this.wanted()
      this.shown = wanted.map((w, i) => this.fade!.from[i] + (w - this.fade!.from[i]) * t)
      if (t >= 1) {
        this.fade = undefined
        this.shown = wanted
      }
    }
    return this.shown
  }
  get fading(): boolean {
    return this.fade !== undefined
  }

  set(group: number, change: Partial<GroupState>): void {
    Object.assign(this.groups[group], change)
    this.scene = -1
    this.fade = undefined
    this.shown = this.wanted()
    this.dispatchEvent(new Event('change'))
  }

  /** A scene of the project: factors on the file's weights; index -1 = the file's own. */
  enterScene(index: number, seconds = 0.8): void {
    const factors = index < 0 ? {} : this.solution.scenes[index].factors
    this.fade = { from: this.factors(performance.now()), start: performance.now(), seconds }
    this.solution.groups.forEach((g, i) => {
      this.groups[i] = { weight: g.weight * (factors[g.name] ?? 1), colour: '#ffffff', solo: false, mute: false }
    })
    this.scene = index
    this.dispatchEvent(new Event('change'))
  }

  /** Goes on with another revision of a solution; whether it has the same groups. */
  continueWith(solution: Solution): boolean {
    if (JSON.stringify(solution.groups) !== JSON.stringify(this.solution.groups)) return false
    this.solution = solution
    return true
  }
}
