// SPDX-License-Identifier: Apache-2.0
// Controls of the panel: each is an element, a name for those who cannot see it, and what it sets.

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

export function numberField(name: string, id: string, value: number, does: (value: number) => void): HTMLInputElement {
  const out = element('input', { type: 'number', id, 'aria-label': name, step: 'any' })
  out.value = String(Number(value.toPrecision(4)))
  out.addEventListener('change', () => {
    if (Number.isFinite(out.valueAsNumber)) does(out.valueAsNumber)
  })
  return out
}

export function section(title: string, id: string, open: boolean, ...children: Child[]): HTMLDetailsElement {
  return element('details', { id, open }, element('summary', {}, title), element('div', {}, ...children))
}

export function row(...children: Child[]): HTMLDivElement {
  return element('div', { class: 'row' }, ...children)
}
