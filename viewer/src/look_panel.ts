// SPDX-License-Identifier: Apache-2.0
// Exposure, false colours, contours, mesh and section.

import { button, check, choice, element, numberField, row, section, slider } from './elements'
import { decimals } from './numbers'
import { roundStep } from './false_colour'
import type { Look } from './shading'
import { colourOfLevel } from './subdivision'
import type { ToneCurve } from './tone'
import type { Viewer } from './viewer'

export function exposurePanel(viewer: Viewer): HTMLElement {
  const value = element('span', { class: 'number' })
  const automatic = check('Automatic', 'exposure-automatic', viewer.automaticExposure, (on) => viewer.setExposure(on))
  const ev = slider('Exposure value', 'exposure-ev', -12, 20, 'any', viewer.ev, (v) => viewer.setExposure(false, v))
  const tone = choice<ToneCurve>('Tone curve', 'tone',
    [['reinhard', 'Reinhard'], ['filmic', 'Filmic'], ['linear', 'Linear']], viewer.toneCurve, (c) => viewer.setToneCurve(c))
  const refresh = () => {
    automatic.querySelector('input')!.checked = viewer.automaticExposure
    ev.value = String(viewer.ev)
    value.textContent = `EV ${decimals(viewer.ev, 1)}`
    tone.value = viewer.toneCurve
  }
  viewer.addEventListener('settings', refresh)
  viewer.addEventListener('exposure', refresh)
  refresh()
  return section('Exposure', 'panel-exposure', true, row(automatic, element('span', { class: 'grow' }), value), ev,
    row(element('span', { class: 'faint' }, 'Tone'), tone))
}

export function lookPanel(viewer: Viewer): HTMLElement {
  const received = viewer.solution.quantity === 'photometric' ? 'Illuminance' : 'Irradiance'
  const look = choice<Look>('Show', 'look', [['picture', 'Picture'], ['illuminance', `${received} (false colour)`],
    ['exitance', 'Exitance (false colour)'], ['normals', 'Normals'], ['reflectance', 'Reflectance'],
    ...(viewer.solution.unshot ? [['unshot', 'Unshot (false colour)'] as [Look, string]] : [])], viewer.look, (value) => viewer.setLook(value))

  const low = numberField('Lowest value of the colours', 'range-low', () => viewer.range.low,
    (v) => viewer.setRange(v, viewer.range.high), () => ({ least: 0, below: viewer.range.high }))
  const high = numberField('Highest value of the colours', 'range-high', () => viewer.range.high,
    (v) => viewer.setRange(viewer.range.low, v), () => ({ above: viewer.range.low }))
  const range = row(low, element('span', { class: 'faint' }, 'to'), high,
    button('Fit', () => viewer.fitRange(), { id: 'range-fit', title: 'From 0 to what 99 % stay below' }))

  // Till one is given, the step follows the range.
  let given: number | undefined
  const stepOf = () => given ?? Number(roundStep(viewer.range.high - viewer.range.low, 8).toPrecision(4))
  const contours = check('Contours every', 'contours', viewer.contour > 0, (on) => viewer.setContour(on ? stepOf() : 0))
  const step = numberField('Step of the contours', 'contour-step', () => viewer.contour || stepOf(), (v) => {
    given = v
    if (viewer.contour > 0) viewer.setContour(v)
  }, () => ({ above: 0 }))
  const wires = check('Mesh by level', 'wires', viewer.wires, (on) => viewer.setWires(on))
  const levels = element('div', { id: 'levels', class: 'faint', 'aria-label': 'How often elements were halved' })

  const cut = choice('Section', 'section-axis', [['-1', 'no section'], ['1', 'cut from above'], ['0', 'cut across'],
    ['2', 'cut along']], '-1', (v) => viewer.setSection({ axis: Number(v) }))
  const at = slider('Place of the section', 'section-at', 0, 1, 'any', viewer.section.at, (v) => viewer.setSection({ at: v }))
  const flip = button('⇄', () => viewer.setSection({ flipped: !viewer.section.flipped }),
    { id: 'section-flip', 'aria-label': 'Show the other side of the section', title: 'The other side' })
  const place = row(at, flip)

  const refresh = () => {
    look.value = viewer.look
    range.hidden = !viewer.inFalseColour
    low.value = String(Number(viewer.range.low.toPrecision(4)))
    high.value = String(Number(viewer.range.high.toPrecision(4)))
    contours.querySelector('input')!.checked = viewer.contour > 0
    step.value = String(Number((viewer.contour || stepOf()).toPrecision(4)))
    place.hidden = viewer.section.axis < 0
    levels.hidden = !viewer.wires
    levels.replaceChildren(...viewer.stage.mesh.levels.map((level) => {
      const swatch = element('i')
      swatch.style.background = colourOfLevel(level).getStyle()
      return element('span', {}, swatch, String(level))
    }))
  }
  viewer.addEventListener('settings', refresh)
  refresh()
  return section('Show', 'panel-show', true, look, range, row(contours, step), wires, levels, cut, place)
}
