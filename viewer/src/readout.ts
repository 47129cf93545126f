// SPDX-License-Identifier: Apache-2.0
// The instrument: what is under the pointer, in numbers.

import { element } from './elements'
import { metres, percent, withUnit } from './numbers'
import type { Reading } from './picking'
import type { Viewer } from './viewer'

export function setUpReadout(viewer: Viewer, output: HTMLElement): void {
  let due = false
  const refresh = () => {
    due = false
    const at = viewer.pointer, sensor = at && viewer.sensorAt(at.x, at.y), surface = at && !sensor && viewer.readAt(at.x, at.y)
    const reading = sensor || surface
    output.hidden = !reading
    if (!reading) return
    const { solution } = viewer, photometric = solution.quantity === 'photometric'
    const [what, where] = sensor ? [sensor.grid || 'sensor grid', `sensor ${sensor.column}, row ${sensor.row}`]
      : [(surface as Reading).surface || 'unnamed surface', (surface as Reading).material]
    const figure = (name: string, value: string, id: string) =>
      element('tr', {}, element('th', { scope: 'row' }, name), element('td', { id }, value))
    const shares = reading.shares.length < 2 ? [] : reading.shares
      .map((share, g) => ({ share, name: solution.groups[g].name || `group ${g + 1}` }))
      .sort((a, b) => b.share - a.share).slice(0, 5)
    output.replaceChildren(
      element('div', { class: 'what' }, what),
      element('div', { class: 'faint' }, where),
      element('table', { class: 'figures' },
        figure(photometric ? 'Illuminance' : 'Irradiance', withUnit(reading.illuminance, photometric ? 'lx' : solution.unit), 'read-irradiance'),
        surface ? figure('Exitance', withUnit(surface.exitance, solution.unit), 'read-exitance') : null,
        figure('Distance', metres(reading.distance), 'read-distance')),
      ...shares.map(({ share, name }) => {
        const filled = element('i')
        filled.style.width = `${100 * share}%`
        return element('div', { class: 'share' }, element('span', { class: 'name' }, name),
          element('span', { class: 'number' }, percent(share)), element('div', { class: 'bar' }, filled))
      }))
  }
  const soon = () => {
    if (due) return
    due = true
    requestAnimationFrame(refresh)
  }
  viewer.addEventListener('pointer', soon)
  viewer.addEventListener('settings', soon)
  viewer.movement.addEventListener('change', soon)  // under a pointer that rests, too
}
