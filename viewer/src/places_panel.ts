// SPDX-License-Identifier: Apache-2.0
// Places to stand: the scene's cameras, one's own bookmarks, and how one moves between.

import { button, check, element, row, section } from './elements'
import { poseOfCamera } from './pose'
import type { Viewer } from './viewer'

export function placesPanel(viewer: Viewer): HTMLElement {
  const { movement, solution } = viewer
  const cameras = solution.cameras.map((camera, i) =>
    button(camera.name || `camera ${i + 1}`, () => movement.flyTo(poseOfCamera(camera, viewer.turn)), { id: `camera-${i}` }))
  const own = element('div', { class: 'buttons', id: 'bookmarks' })
  const refresh = () => own.replaceChildren(...viewer.bookmarks.map((place, i) =>
    button(`Place ${i + 1}`, () => movement.flyTo(viewer.poseAt(place.eye, place.look_at, place.fov)))))
  viewer.addEventListener('bookmarks', refresh)
  refresh()
  const keep = button('Keep this place', () => viewer.keepPlace(), { id: 'bookmark' })
  const gravity = check('Feet on the ground', 'gravity', movement.gravity, (on) => (movement.gravity = on))
  const automatic = check('Automatic', 'automatic', movement.automatic, (on) => movement.setAutomatic(on))
  movement.addEventListener('change', () => (automatic.querySelector('input')!.checked = movement.automatic))
  const mouse = button('Mouse look', () => void movement.lockPointer().catch(() => {}), { id: 'mouse-look', title: 'Until Esc' })
  return section('Places', 'panel-places', true,
    cameras.length > 0 ? element('div', { class: 'buttons' }, ...cameras) : null, own,
    row(keep, button('Back to the start', () => movement.reset(), { id: 'reset', title: 'r' })),
    row(gravity, automatic), row(mouse))
}
