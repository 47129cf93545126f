// SPDX-License-Identifier: Apache-2.0
// Sensor grids with their figures, and the tape.

import { check, element, section } from './elements'
import { notifyError } from './notice'
import { decimals, figures } from './numbers'
import type { SensorGrids } from './sensor_grids'
import type { Tape } from './tape'
import type { Viewer } from './viewer'

export function measurePanel(viewer: Viewer, grids: SensorGrids, tape: Tape): HTMLElement {
  const table = element('table', { class: 'figures', id: 'grid-figures' })
  const unit = viewer.solution.quantity === 'photometric' ? 'lx' : viewer.solution.unit
  const refresh = () => {
    const box = sensors?.querySelector('input')
    if (box) box.checked = grids.wanted
    table.hidden = grids.figures.length === 0
    table.replaceChildren(
      element('tr', {}, element('th', { scope: 'col' }, unit), ...['min', 'mean', 'min/mean'].map((t) => element('th', { scope: 'col' }, t))),
      ...grids.figures.map((f) => element('tr', {}, element('th', { scope: 'row' }, f.name),
        element('td', {}, figures(f.min)), element('td', {}, figures(f.mean)), element('td', {}, decimals(f.uniformity, 2)))))
  }
  const sensors = viewer.solution.grids.length > 0
    ? check('Sensor grids', 'grids-shown', grids.wanted, (on) => void grids.show(on).catch(notifyError)) : null
  grids.addEventListener('change', refresh)
  refresh()
  return section('Measure', 'panel-measure', false, sensors, table,
    check('Tape: tap two places', 'tape', false, (on) => tape.setOn(on)))
}
