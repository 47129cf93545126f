// SPDX-License-Identifier: Apache-2.0
// What one takes away: a picture, the mix of lights as a model, a link to this place.

import { button, element, numberField, row, section } from './elements'
import { exportMix } from './export_glb'
import { notifyError } from './notice'
import { percent } from './numbers'
import { ask } from './program'
import { LEAST_PICTURE, MOST_PICTURE } from './stage'
import type { Viewer } from './viewer'

function download(blob: Blob, name: string): void {
  const link = element('a', { href: URL.createObjectURL(blob), download: name })
  link.click()
  setTimeout(() => URL.revokeObjectURL(link.href), 10000)
}

/** A button that makes a file and hands it over; the user is told how far that is, and where it fails. */
function saver(text: string, id: string, file: string, make: (done: (share: number) => void) => Promise<Blob>, title?: string): HTMLButtonElement {
  const out = button(text, () => {
    out.disabled = true
    make((share) => (out.textContent = share < 1 ? percent(share) : text)).then((blob) => download(blob, file)).catch(notifyError)
      .finally(() => {
        out.disabled = false
        out.textContent = text
      })
  }, { id, title })
  return out
}

/** The address of this page with where one stands, and the brightness and colour of the lights. */
export function linkHere(viewer: Viewer): string {
  const { eye, look_at, fov } = viewer.place()
  const numbers = (values: number[]) => values.map((v) => Number(v.toFixed(4))).join(',')
  const here = new URLSearchParams({ eye: numbers(eye), at: numbers(look_at), fov: String(Number(fov.toFixed(2))),
    mode: viewer.movement.mode, light: numbers(viewer.mix.brightness()),
    colour: viewer.mix.groups.map((g) => g.colour.slice(1)).join(',') })
  return `${location.href.split('#')[0]}#${here.toString().replaceAll('%2C', ',')}`
}

/** Goes where such a link leads; whether it said where. */
export function followLink(viewer: Viewer, hash: string): boolean {
  const here = new URLSearchParams(hash.replace(/^#/, ''))
  const numbers = (name: string) => (here.get(name) ?? '').split(',').map(Number)
  const [eye, at, fov, light] = [numbers('eye'), numbers('at'), Number(here.get('fov')), numbers('light')]
  if (light.length === viewer.mix.groups.length && light.every((w) => Number.isFinite(w) && w >= 0) && here.has('light'))
    light.forEach((weight, g) => viewer.mix.set(g, { weight }))
  const colours = (here.get('colour') ?? '').split(',')
  if (colours.length === viewer.mix.groups.length && colours.every((c) => /^[0-9a-f]{6}$/.test(c)))
    colours.forEach((c, g) => viewer.mix.set(g, { colour: `#${c}` }))
  if (here.get('mode') === 'walk') viewer.movement.setMode('walk')
  const valid = [...eye, ...at, fov].every(Number.isFinite) && eye.length === 3 && at.length === 3 && fov > 1 && fov < 179
  if (valid) viewer.movement.pose = viewer.poseAt(eye, at, fov)
  return valid
}

export function savePanel(viewer: Viewer): HTMLElement {
  const name = (viewer.solution.title || 'exitance').replace(/[^\w-]+/g, '_').toLowerCase()
  let width = 1920, height = 1080
  const sides = () => ({ least: LEAST_PICTURE, most: MOST_PICTURE, whole: true })
  const w = numberField('Width of the picture in pixels', 'picture-width', () => width, (v) => (width = v), sides)
  const h = numberField('Height of the picture in pixels', 'picture-height', () => height, (v) => (height = v), sides)
  const picture = saver('Picture', 'picture', `${name}.png`, (done) => viewer.picture(width, height, done))
  const mix = saver('Model with this light', 'export', `${name}_lit.glb`, async () => exportMix(viewer), 'A .glb with plain vertex colours')
  const link = button('Link to here', async () => {
    const url = linkHere(viewer)
    history.replaceState(null, '', url.slice(url.indexOf('#')))
    try {
      await navigator.clipboard.writeText(url)
      link.textContent = 'Copied'
    } catch {
      link.textContent = 'In the address bar'
    }
    setTimeout(() => (link.textContent = 'Link to here'), 1500)
  }, { id: 'link' })
  // What is shown as the program has it; a page of its own holds it in another form.
  const whole = document.getElementById('grids') ? null
    : saver('Solution', 'solution-file', `${name}.glb`, async () => new Blob([(await ask('solution.glb')).bytes]), 'The .glb with the light of every group')
  return section('Save and share', 'panel-save', false,
    row(w, element('span', { class: 'faint' }, '×'), h, picture), element('div', { class: 'buttons' }, mix, whole, link))
}
