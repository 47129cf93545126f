// SPDX-License-Identifier: Apache-2.0
// What is shown and how far it can be trusted: size, error estimate, energy balance.

import { element, section } from './elements'
import { count, fine } from './numbers'
import type { Viewer } from './viewer'

export function aboutPanel(viewer: Viewer): HTMLElement {
  const table = element('table', { class: 'figures', id: 'about' })
  const refresh = () => {
    const { solution } = viewer, { error, energy } = solution
    const line = (name: string, value: string, title?: string) =>
      element('tr', { title }, element('th', { scope: 'row' }, name), element('td', {}, value))
    const share = (part: number) => (energy.emitted > 0 ? fine(part / energy.emitted) : '\u2013')
    table.replaceChildren(
      line('Triangles', count(solution.indices.length / 3)),
      line('Vertices', count(solution.positions.length / 3)),
      line('Light groups', count(solution.groups.length)),
      line('Error', error ? `${fine(error.rms)} \u00b1 ${fine(error.confidence)}` : 'not estimated',
        'RMS of irradiance over its mean, at points that the solver did not see'),
      line('Absorbed', share(energy.absorbed + energy.absorbed_behind), 'of the light emitted'),
      line('Escaped', share(energy.escaped)),
      line('Unshot', share(Math.max(0, energy.unshot))))
  }
  viewer.addEventListener('solution', refresh)
  refresh()
  return section('About', 'panel-about', false, table)
}
