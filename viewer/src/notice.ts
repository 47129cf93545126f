// SPDX-License-Identifier: Apache-2.0
// What must not go unnoticed: one line above the picture, until it is closed or another follows.

import { byId } from './elements'

export function notify(text: string): void {
  byId('notice-text').textContent = text
  byId('notice').hidden = false
}

export const notifyError = (error: unknown) => notify(error instanceof Error ? error.message : String(error))

/** What nobody else has caught is told as well. */
export function setUpNotice(): void {
  byId('notice-close').addEventListener('click', () => (byId('notice').hidden = true))
  addEventListener('unhandledrejection', (event) => notifyError(event.reason))
  addEventListener('error', (event) => notify(event.message))
}
