// SPDX-License-Identifier: Apache-2.0
// The scale that tells what a false colour means.

import { element } from './elements'
import { cssColour, falseColour, roundMarks } from './false_colour'
import { mark } from './numbers'
import type { Viewer } from './viewer'

export function setUpLegend(viewer: Viewer, figure: HTMLElement): void {
  const canvas = element('canvas', { width: 1, height: 128 })
  const context = canvas.getContext('2d')!
  for (let y = 0; y < 128; ++y) {
    context.fillStyle = cssColour(falseColour((127.5 - y) / 128))
    context.fillRect(0, y, 1, 1)
  }
  const marks = element('div', { class: 'marks' }), caption = element('figcaption')
  figure.append(caption, element('div', { class: 'scale' }, canvas, marks))

  const refresh = () => {
    figure.hidden = viewer.look !== 'illuminance' && viewer.look !== 'exitance'
    if (figure.hidden) return
    const { low, high } = viewer.range
    const name = viewer.look === 'exitance' ? 'Exitance'
      : viewer.solution.quantity === 'photometric' ? 'Illuminance' : 'Irradiance'
    const unit = viewer.look === 'illuminance' && viewer.solution.quantity === 'photometric' ? 'lx' : viewer.solution.unit
    caption.textContent = unit ? `${name}, ${unit}` : name
    const values = roundMarks(low, high, 7), step = values.length > 1 ? values[1] - values[0] : 1
    marks.replaceChildren(...values.map((value) => {
      const span = element('span', { 'data-value': value }, mark(value, step))
      span.style.bottom = `${100 * (value - low) / (high - low)}%`
      return span
    }))
  }
  viewer.addEventListener('settings', refresh)
  viewer.addEventListener('solution', refresh)
}
