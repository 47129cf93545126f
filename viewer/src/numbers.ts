// SPDX-License-Identifier: Apache-2.0
// Numbers as the reader's language writes them.

const formats = new Map<string, Intl.NumberFormat>()

function format(options: Intl.NumberFormatOptions): Intl.NumberFormat {
  const key = JSON.stringify(options)
  if (!formats.has(key)) formats.set(key, new Intl.NumberFormat(navigator.languages as string[], options))
  return formats.get(key)!
}

/** Three figures: what an instrument shows. */
export function figures(value: number): string {
  if (!Number.isFinite(value)) return '–'
  return Math.abs(value) >= 1000
    ? format({ maximumFractionDigits: 0 }).format(value)
    : format({ minimumSignificantDigits: 3, maximumSignificantDigits: 3 }).format(value)
}

export function withUnit(value: number, unit: string): string {
  return unit ? `${figures(value)} ${unit}` : figures(value)
}

/** A share or factor: "42 %". */
export function percent(value: number): string {
  return format({ style: 'percent', maximumFractionDigits: 0 }).format(value)
}

/** A share to the tenth of a percent. */
export function fine(value: number): string {
  return format({ style: 'percent', minimumFractionDigits: 1, maximumFractionDigits: 1 }).format(value)
}

export function count(value: number): string {
  return format({ maximumFractionDigits: 0 }).format(value)
}

/** To four figures, as many as it needs. */
export function general(value: number): string {
  return format({ maximumSignificantDigits: Math.abs(value) >= 1000 ? 9 : 4, useGrouping: false }).format(value)
}

/** Metres, to the millimetre where that says something. */
export function metres(value: number): string {
  return `${format({ minimumFractionDigits: 2, maximumFractionDigits: Math.abs(value) < 10 ? 3 : 2 }).format(value)} m`
}

export function decimals(value: number, digits: number): string {
  return format({ minimumFractionDigits: digits, maximumFractionDigits: digits }).format(value)
}

/** A mark of a scale whose marks are `step` apart. */
export function mark(value: number, step: number): string {
  const digits = Math.min(8, Math.max(0, Math.ceil(-Math.log10(step) - 1e-9)))
  return decimals(value, digits)
}
