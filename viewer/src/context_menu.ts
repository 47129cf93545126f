// SPDX-License-Identifier: Apache-2.0
// The menu of the right button: manual or automatic, as radview has it, and what else belongs to a place.

import { element } from './elements'
import type { Viewer } from './viewer'

export class ContextMenu {
  private menu: HTMLElement

  constructor(private viewer: Viewer, place: HTMLElement) {
    this.menu = element('div', { id: 'menu', role: 'menu', 'aria-label': 'Movement', hidden: true })
    place.append(this.menu)
    viewer.movement.onMenu = (x, y) => this.open(x, y)
    this.menu.addEventListener('keydown', (event) => this.key(event))
    this.menu.addEventListener('focusout', (event) => {
      if (!this.menu.contains(event.relatedTarget as Node | null)) this.menu.hidden = true
    })
  }

  private items(): HTMLElement[] {
    return [...this.menu.children] as HTMLElement[]
  }

  private open(x: number, y: number): void {
    const { movement } = this.viewer, place = this.viewer.pickAt(x, y)
    const item = (text: string, id: string, does: () => void, checked?: boolean) => {
      const out = element('button', { type: 'button', id, tabindex: -1, role: checked === undefined ? 'menuitem' : 'menuitemradio',
        'aria-checked': checked === undefined ? undefined : String(checked) }, text)
      out.addEventListener('click', () => {
        this.close()
        does()
      })
      return out
    }
    this.menu.replaceChildren(
      item('Manual', 'menu-manual', () => movement.setAutomatic(false), !movement.automatic),
      item('Automatic', 'menu-automatic', () => movement.setAutomatic(true), movement.automatic),
      ...(place ? [item('Go there', 'menu-go', () => movement.onDoubleTap(x, y))] : []),
      item('Keep this place', 'menu-keep', () => this.viewer.keepPlace()),
      item('Back to the start', 'menu-reset', () => movement.reset()))
    this.menu.hidden = false
    this.menu.style.left = `${Math.min(x, innerWidth - this.menu.offsetWidth - 8)}px`
    this.menu.style.top = `${Math.min(y, innerHeight - this.menu.offsetHeight - 8)}px`
    this.items()[movement.automatic ? 1 : 0].focus()
  }

  private close(): void {
    this.menu.hidden = true
    this.viewer.canvas.focus({ preventScroll: true })
  }

  private key(event: KeyboardEvent): void {
    const items = this.items(), at = items.indexOf(document.activeElement as HTMLElement), n = items.length
    const to: Record<string, number> = { ArrowDown: (at + 1) % n, ArrowUp: (at + n - 1) % n, Home: 0, End: n - 1 }
    if (event.key in to) items[to[event.key]].focus()
    else if (event.key === 'Escape' || event.key === 'Tab') this.close()
    else return
    event.preventDefault()
    event.stopPropagation()
  }
}
