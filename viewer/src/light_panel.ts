// SPDX-License-Identifier: Apache-2.0
// One row of controls per light group, and the named scenes.

import { choice, element, row, section, slider, toggle } from './elements'
import { percent } from './numbers'
import type { Viewer } from './viewer'

export function lightPanel(viewer: Viewer): HTMLElement {
  const { solution, mix } = viewer
  const refreshers: (() => void)[] = []

  const rows = solution.groups.map((group, g) => {
    const name = group.name || `group ${g + 1}`
    const most = Math.max(2, 2 * group.weight)
    const value = element('span', { class: 'number' })
    const colour = element('input', { type: 'color', id: `colour-${g}`, 'aria-label': `Colour of ${name}`, title: 'Colour filter' })
    colour.addEventListener('input', () => mix.set(g, { colour: colour.value }))
    const weight = slider(`Brightness of ${name}`, `weight-${g}`, 0, most, 'any', group.weight, (w) => mix.set(g, { weight: w }))
    weight.addEventListener('dblclick', () => mix.set(g, { weight: group.weight }))
    const solo = toggle('S', `Only ${name}`, (on) => mix.set(g, { solo: on }), `solo-${g}`)
    const mute = toggle('M', `Switch off ${name}`, (on) => mix.set(g, { mute: on }), `mute-${g}`)
    refreshers.push(() => {
      const state = mix.groups[g]
      weight.value = String(state.weight)
      colour.value = state.colour
      value.textContent = percent(state.weight)
      solo.setAttribute('aria-pressed', String(state.solo))
      mute.setAttribute('aria-pressed', String(state.mute))
    })
    return element('div', { class: 'group', role: 'group', 'aria-label': name },
      row(colour, element('span', { class: 'name', title: name }, name), value, solo, mute), weight)
  })

  const scenes = solution.scenes.length > 0
    ? choice('Scene', 'scene', [['-1', 'as solved'], ...solution.scenes.map((s, i) => [String(i), s.name] as [string, string]),
      ['mixed', 'mixed by hand']], '-1', (value) => {
      if (value !== 'mixed') mix.enterScene(Number(value))
    })
    : null
  if (scenes) refreshers.push(() => (scenes.value = mix.scene >= 0 ? String(mix.scene) : isAsSolved() ? '-1' : 'mixed'))
  const isAsSolved = () => mix.groups.every((g, i) =>
    g.weight === solution.groups[i].weight && g.colour === '#ffffff' && !g.mute && !g.solo)

  const refresh = () => refreshers.forEach((each) => each())
  mix.addEventListener('change', refresh)
  refresh()
  return section('Light', 'panel-light', true, scenes && row(element('span', { class: 'faint' }, 'Scene'), scenes), ...rows)
}
