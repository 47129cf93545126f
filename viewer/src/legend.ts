// SPDX-License-Identifier: Apache-2.0
// The scale that tells what a false colour means; its two handles set the range of the colours.

import { element } from './elements'
import { cssColour, falseColour, roundMarks } from './false_colour'
import { figures, mark, withUnit } from './numbers'
import type { Viewer } from './viewer'

type End = 'low' | 'high'
const ROWS = 240

export function setUpLegend(viewer: Viewer, figure: HTMLElement): void {
  const canvas = element('canvas', { width: 1, height: ROWS })
  const context = canvas.getContext('2d')!
  const marks = element('div', { class: 'marks' }), caption = element('figcaption')
  const handle = (end: End) => element('div', { id: `legend-${end}`, class: 'handle', role: 'slider', tabindex: 0,
    'aria-orientation': 'vertical', 'aria-label': end === 'low' ? 'Lowest value of the colours' : 'Highest value of the colours' })
  const handles = { low: handle('low'), high: handle('high') }
  const scale = element('div', { class: 'scale' }, canvas, marks, handles.low, handles.high)
  figure.append(caption, scale)
  let top = 1, held: End | undefined  // what the scale ends at; it stays while a handle is held

  const move = (end: End, to: number) => {
    const { low, high } = viewer.range, least = 0.01 * top
    const value = Math.min(top, Math.max(0, to))
    if (end === 'low') viewer.setRange(Math.min(value, high - least), high)
    else viewer.setRange(low, Math.max(value, low + least))
  }
  for (const end of ['low', 'high'] as End[]) {
    const node = handles[end]
    node.addEventListener('pointerdown', (event) => {
      held = end
      node.setPointerCapture(event.pointerId)
      event.preventDefault()
      node.focus()
    })
    node.addEventListener('pointermove', (event) => {
      if (held !== end) return
      const box = scale.getBoundingClientRect()
      move(end, top * (box.bottom - event.clientY) / box.height)
    })
    for (const over of ['pointerup', 'pointercancel'])
      node.addEventListener(over, () => {
        held = undefined
        refresh()
      })
    node.addEventListener('keydown', (event) => {
      const steps: Record<string, number> = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1, PageUp: 10, PageDown: -10 }
      const value = viewer.range[end], step = top / 100
      if (event.key in steps) move(end, value + steps[event.key] * step)
      else if (event.key === 'Home') move(end, 0)
      else if (event.key === 'End') move(end, top)
      else return
      event.preventDefault()
    })
  }

  const refresh = () => {
    figure.hidden = !viewer.inFalseColour
    if (figure.hidden) return
    const { low, high } = viewer.range, { name, unit } = viewer.quantity
    caption.textContent = unit ? `${name}, ${unit}` : name
    if (!held) top = Math.max(high, viewer.most)
    for (let y = 0; y < ROWS; ++y) {
      context.fillStyle = cssColour(falseColour(((ROWS - 0.5 - y) / ROWS * top - low) / (high - low)))
      context.fillRect(0, y, 1, 1)
    }
    scale.dataset.top = String(top)
    const values = roundMarks(0, top, 7), step = values.length > 1 ? values[1] - values[0] : 1
    marks.replaceChildren(...values.map((value) => {
      const span = element('span', { 'data-value': value }, mark(value, step))
      span.style.bottom = `${100 * value / top}%`
      return span
    }))
    for (const end of ['low', 'high'] as End[]) {
      const node = handles[end], value = viewer.range[end]
      node.style.bottom = `${100 * value / top}%`
      node.title = figures(value)
      node.setAttribute('aria-valuemin', '0')
      node.setAttribute('aria-valuemax', String(top))
      node.setAttribute('aria-valuenow', String(value))
      node.setAttribute('aria-valuetext', withUnit(value, unit))
    }
  }
  viewer.addEventListener('settings', refresh)
  viewer.addEventListener('solution', refresh)
}
