// SPDX-License-Identifier: Apache-2.0
// What must not go unnoticed: one line above the picture, until it is closed, another follows or it has been there
// for long enough to be read.

import { byId } from './elements'

const readWithin = 20_000 // ms
let hiding = 0

export function notify(text: string): void {
  byId('notice-text').textContent = text
  byId('notice').hidden = false
  clearTimeout(hiding)
  hiding = window.setTimeout(() => (byId('notice').hidden = true), readWithin)
}

export const notifyError = (error: unknown) => notify(error instanceof Error ? error.message : String(error))

/** What nobody else has caught is told as well. */
export function setUpNotice(): void {
  byId('notice-close').addEventListener('click', () => (byId('notice').hidden = true))
  addEventListener('unhandledrejection', (event) => notifyError(event.reason))
  addEventListener('error', (event) => notify(event.message))
}
