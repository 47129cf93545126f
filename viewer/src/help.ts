// SPDX-License-Identifier: Apache-2.0
// The keys, as F1 shows them.

import { button, element } from './elements'

const KEYS: [string, [string, string][]][] = [
  ['Orbit', [['Drag', 'azimuth and elevation'], ['Wheel, pinch', 'nearer, farther'], ['Right drag, two fingers', 'slide'],
    ['Arrows', 'azimuth and elevation by 1°'], ['z x', 'zoom in, out'], ['a s', 'move viewpoint and reference along, against the line of sight']]],
  ['Walk', [['W A S D', 'walk'], ['Shift', 'run'], ['Drag, arrows', 'look'], ['E Q', 'rise, sink (feet off the ground)'],
    ['Mouse look', 'looks without dragging, until Esc']]],
  ['Both', [['Click', 'in orbit: turn to it and about it'], ['Double-click', 'go there'], ['Right click', 'menu: manual, automatic'], ['r', 'back to the start'], ['Tab', 'to the controls and on'], ['F1 F2', 'open, close this help'],
    ['Esc', 'leave; twice ends the visit'], ['Gamepad', 'left stick walks, right stick looks'],
    ['Headset', 'trigger or right stick forward teleports, right stick turns, left stick walks']]],
  ['Light', [['Brightness', 'double-click: as solved'], ['S M', 'only this group; without it']]],
]

export function setUpHelp(dialog: HTMLDialogElement, opener: HTMLElement): void {
  dialog.append(element('h2', { id: 'help-title' }, 'Keys and gestures'),
    element('div', { class: 'columns' }, ...KEYS.map(([title, keys]) =>
      element('section', {}, element('h3', {}, title), element('dl', {}, ...keys.flatMap(([key, what]) =>
        [element('dt', {}, element('kbd', {}, key)), element('dd', {}, what)]))))),
    element('p', {}, button('Close', () => dialog.close(), { id: 'help-close' })))
  const open = () => {
    dialog.showModal()
    dialog.scrollTop = 0  // the focus is at its end
  }
  opener.addEventListener('click', open)
  addEventListener('keydown', (event) => {
    if (event.key === 'F1' && !dialog.open) open()
    else if (event.key === 'F2' && dialog.open) dialog.close()
    else return
    event.preventDefault()
  })
}
