// SPDX-License-Identifier: Apache-2.0
// Controls of the panel: each is an element, a name for those who cannot see it, and what it sets.

import { notify } from './notice'
import { general } from './numbers'

type Attributes = Record<string, string | boolean | number | undefined>
type Child = Node | string | null | undefined

export function element<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[Tag] {
  const out = document.createElement(tag)
  for (const [name, value] of Object.entries(attributes))
    if (value !== undefined && value !== false) out.setAttribute(name, value === true ? '' : String(value))
  for (const child of children) if (child != null) out.append(child)
  return out
}

export function byId<Type extends HTMLElement>(id: string): Type {
  return document.getElementById(id) as Type
}

export function button(text: string, does: () => void, attributes: Attributes = {}): HTMLButtonElement {
  const out = element('button', { type: 'button', ...attributes }, text)
  out.addEventListener('click', does)
  return out
}

export function toggle(text: string, name: string, does: (on: boolean) => void, id?: string): HTMLButtonElement {
  const out = button(text, () => {
    const on = out.getAttribute('aria-pressed') !== 'true'
    out.setAttribute('aria-pressed', String(on))
    does(on)
  }, { 'aria-pressed': 'false', 'aria-label': name, title: name, id })
  return out
}

export function check(text: string, id: string, on: boolean, does: (on: boolean) => void): HTMLLabelElement {
  const box = element('input', { type: 'checkbox', id })
  box.checked = on
  box.addEventListener('change', () => does(box.checked))
  return element('label', { class: 'check' }, box, text)
}

export function slider(name: string, id: string, low: number, high: number, step: number | 'any', value: number,
  does: (value: number) => void): HTMLInputElement {
  const out = element('input', { type: 'range', id, 'aria-label': name, min: low, max: high, step })
  out.value = String(value)
  out.addEventListener('input', () => does(out.valueAsNumber))
  return out
}

export function choice<Value extends string>(name: string, id: string, values: [Value, string][], value: Value,
  does: (value: Value) => void): HTMLSelectElement {
  const out = element('select', { id, 'aria-label': name },
    ...values.map(([key, text]) => element('option', { value: key }, text)))
  out.value = value
  out.addEventListener('change', () => does(out.value as Value))
  return out
}

/** What a number must be; `above` and `below` are not allowed themselves. */
export interface Limits { least?: number; most?: number; above?: number; below?: number; whole?: boolean }

/** A field that always shows the number in use: what is given outside the limits is not taken, and the user is told
 * why. `holds` is the number in use, `does` takes another. */
export function numberField(name: string, id: string, holds: () => number, does: (value: number) => void,
  limits: () => Limits = () => ({})): HTMLInputElement {
  const out = element('input', { type: 'number', id, 'aria-label': name, step: 'any' })
  const show = () => (out.value = String(Number(holds().toPrecision(limits().whole ? 15 : 4))))
  show()
  out.addEventListener('change', () => {
    const { least = -Infinity, most = Infinity, above = -Infinity, below = Infinity, whole } = limits()
    const value = whole ? Math.round(out.valueAsNumber) : out.valueAsNumber
    if (value >= least && value <= most && value > above && value < below) {
      does(value)
    } else {
      const bounds = [[least, 'at least'], [above, 'more than'], [most, 'at most'], [below, 'less than']] as const
      const expected = bounds.filter(([bound]) => Number.isFinite(bound)).map(([bound, words]) => `${words} ${general(bound)}`)
      notify(`${name}: ${Number.isFinite(value) ? general(value) : 'that'} is not possible, expected ${expected.join(' and ') || 'a number'}; `
        + `it stays ${general(holds())}.`)
    }
    show()
  })
  return out
}

export function section(title: string, id: string, open: boolean, ...children: Child[]): HTMLDetailsElement {
  return element('details', { id, open }, element('summary', {}, title), element('div', {}, ...children))
}

export function row(...children: Child[]): HTMLDivElement {
  return element('div', { class: 'row' }, ...children)
}
