// SPDX-License-Identifier: Apache-2.0
// The walkthrough, put together.

import './style.css'
import { aboutPanel } from './about_panel'
import { ContextMenu } from './context_menu'
import { byId } from './elements'
import { FloatingLabels } from './floating_labels'
import { Headset } from './headset'
import { setUpHelp } from './help'
import { setUpLegend } from './legend'
import { lightPanel } from './light_panel'
import { exposurePanel, lookPanel } from './look_panel'
import { measurePanel } from './measure_panel'
import type { Mode } from './movement'
import { notify, setUpNotice } from './notice'
import { placesPanel } from './places_panel'
import { setUpReadout } from './readout'
import { followLink, savePanel } from './save_panel'
import { SensorGrids } from './sensor_grids'
import type { Solution } from './solution'
import { embeddedSolution, Server } from './source'
import { Tape } from './tape'
import { Viewer } from './viewer'

const LEAST_WIDTH = 220  // of the controls [px]

const message = (text: string) => (byId('message').textContent = text)

function setUpBar(viewer: Viewer): void {
  const buttons: Record<Mode, HTMLElement> = { orbit: byId('orbit'), walk: byId('walk') }
  for (const mode of ['orbit', 'walk'] as Mode[]) {
    buttons[mode].addEventListener('click', () => {
      viewer.movement.setMode(mode)
      viewer.canvas.focus()
    })
    // One of the two is a stop of Tab; arrows change between them.
    buttons[mode].addEventListener('keydown', (event) => {
      if (!event.key.startsWith('Arrow')) return
      const other = mode === 'orbit' ? 'walk' : 'orbit'
      viewer.movement.setMode(other)
      buttons[other].focus()
      event.preventDefault()
    })
  }
  const refresh = () => {
    for (const mode of ['orbit', 'walk'] as Mode[]) {
      buttons[mode].setAttribute('aria-checked', String(viewer.movement.mode === mode))
      buttons[mode].tabIndex = viewer.movement.mode === mode ? 0 : -1
    }
  }
  viewer.movement.addEventListener('change', refresh)
  refresh()
}

function setUpPanel(): void {
  const panel = byId('panel'), toggle = byId('panel-toggle'), edge = byId('panel-edge')
  const show = (shown: boolean) => {
    panel.hidden = !shown
    toggle.setAttribute('aria-expanded', String(shown))
  }
  toggle.addEventListener('click', () => show(panel.hidden))
  if (innerWidth <= 640) show(false)
  const widen = (width: number) => {
    const most = innerWidth - 40, to = Math.min(most, Math.max(LEAST_WIDTH, width))
    panel.style.width = `${to}px`
    tell(to, most)
  }
  const tell = (now: number, most: number) => {
    for (const [name, value] of [['min', LEAST_WIDTH], ['max', most], ['now', now]] as const)
      edge.setAttribute(`aria-value${name}`, String(Math.round(value)))
  }
  tell(panel.offsetWidth, innerWidth - 40)
  edge.addEventListener('pointerdown', (event) => edge.setPointerCapture(event.pointerId))
  edge.addEventListener('pointermove', (event) => {
    if (event.buttons & 1) widen(panel.getBoundingClientRect().right - event.clientX)
  })
  edge.addEventListener('keydown', (event) => {
    const step = event.key === 'ArrowLeft' ? 16 : event.key === 'ArrowRight' ? -16 : 0
    if (step) widen(panel.offsetWidth + step)
  })
}

/** Esc leaves what is open; where nothing is, a second one ends the visit, as in radview. */
function setUpEscape(server: Server | null): void {
  let asked = -1e9
  byId('view').addEventListener('keydown', (event) => {
    if (event.key !== 'Escape' || document.pointerLockElement) return
    if (event.timeStamp - asked < 3000) {
      server?.leave()
      message('The visit has ended; this page can be closed.')
      return
    }
    asked = event.timeStamp
    message('Esc again ends the visit.')
    setTimeout(() => byId('message').textContent?.startsWith('Esc') && message(''), 3000)
  })
}

function fillPanel(viewer: Viewer, grids: SensorGrids, tape: Tape): void {
  const open = new Map([...document.querySelectorAll('#panel details')].map((d) => [d.id, (d as HTMLDetailsElement).open]))
  const panels = [lightPanel(viewer), exposurePanel(viewer), lookPanel(viewer), placesPanel(viewer),
    measurePanel(viewer, grids, tape), savePanel(viewer), aboutPanel(viewer)]
  for (const panel of panels) (panel as HTMLDetailsElement).open = open.get(panel.id) ?? (panel as HTMLDetailsElement).open
  byId('panel-content').replaceChildren(...panels)
}

/** Rebuilt only where the groups, scenes or cameras are others than before. */
function signature(solution: Solution): string {
  return JSON.stringify([solution.groups, solution.scenes, solution.cameras, solution.grids, solution.quantity, !!solution.unshot])
}

function start(): void {
  const viewer = new Viewer(byId<HTMLCanvasElement>('view'))
  const labels = new FloatingLabels(viewer, byId('labels'))
  const grids = new SensorGrids(viewer, labels), tape = new Tape(viewer, labels)
  const headset = new Headset(viewer, byId<HTMLButtonElement>('headset'))
  viewer.inHeadset = (seconds, frame) => headset.advance(seconds, frame)
  viewer.movement.takesTap = (x, y) => tape.tap(x, y)
  viewer.movement.onTap = (x, y) => viewer.lookAt(x, y)
  new ContextMenu(viewer, document.body)
  let shape = ''
  const show = async (solution: Solution) => {
    const first = shape === ''
    await viewer.show(solution)
    document.title = solution.title ? `${solution.title} – Exitance` : 'Exitance'
    byId('title').textContent = byId('title').title = solution.title
    if (!server && solution.energy.emitted <= 0) notify('Nothing emits light here: it stays dark.')
    if (signature(solution) !== shape) fillPanel(viewer, grids, tape)
    shape = signature(solution)
    if (!first) return
    followLink(viewer, location.hash)
    viewer.settle()
    viewer.canvas.focus({ preventScroll: true })
    message('')
  }
  setUpNotice()
  setUpBar(viewer)
  setUpPanel()
  setUpLegend(viewer, byId('legend'))
  setUpReadout(viewer, byId('readout'))
  setUpHelp(byId<HTMLDialogElement>('help'), byId('help-open'))
  addEventListener('hashchange', () => followLink(viewer, location.hash) && viewer.changed())

  const inside = embeddedSolution()
  const server = inside ? null : new Server(show, message)
  setUpEscape(server)
  if (inside) show(inside).catch((error) => message(String(error)))
  // For tests and scripts: reads back what the page shows.
  Object.assign(window, { exitance: { viewer, server, grids, tape } })
}

start()
