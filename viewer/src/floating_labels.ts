// SPDX-License-Identifier: Apache-2.0
// Text that stays with a place in the scene.

import * as THREE from 'three'
import { element } from './elements'
import type { Viewer } from './viewer'

interface Label { at: THREE.Vector3; node: HTMLElement; owner: string }

export class FloatingLabels {
  private labels: Label[] = []

  constructor(private viewer: Viewer, private layer: HTMLElement) {
    viewer.addEventListener('drawn', () => this.follow())
  }

  /** Replaces what `owner` has put up; places in the page's frame. */
  set(owner: string, labels: { at: THREE.Vector3; text: string; small?: boolean }[]): void {
    for (const label of this.labels) if (label.owner === owner) label.node.remove()
    this.labels = this.labels.filter((label) => label.owner !== owner)
    for (const { at, text, small } of labels) {
      const node = element('span', { class: small ? 'point' : undefined }, text)
      this.layer.append(node)
      this.labels.push({ at, node, owner })
    }
    this.viewer.changed()
  }

  private follow(): void {
    const { canvas, stage } = this.viewer
    for (const { at, node, owner } of this.labels) {
      const seen = at.clone().project(stage.camera)
      node.hidden = seen.z > 1 || Math.abs(seen.x) > 1.1 || Math.abs(seen.y) > 1.1
        || (owner !== 'tape' && this.viewer.isHidden(at))
      const x = (seen.x + 1) / 2 * canvas.clientWidth, y = (1 - seen.y) / 2 * canvas.clientHeight
      node.style.transform = `translate(-50%, -50%) translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`
    }
  }
}
