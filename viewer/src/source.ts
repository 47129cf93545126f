// SPDX-License-Identifier: Apache-2.0
// Where the solution comes from: the program that serves this page, or the page itself.

import { applyDelta } from './byte_delta'
import { byId, element } from './elements'
import { notify, notifyError } from './notice'
import { count, fine, percent } from './numbers'
import { ask } from './program'
import { readSolution, type Solution } from './solution'

interface Progress { phase: string; seconds: number; done: number; paused: boolean; fraction_left: number; vertices: number; shots: number; error?: number }

/** The solution that the page carries inside, if it does. */
export function embeddedSolution(): Solution | null {
  const script = document.getElementById('solution')
  if (!script) return null
  const text = atob(script.textContent!)
  script.remove()
  const bytes = new Uint8Array(text.length)
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i)
  return readSolution(bytes.buffer)
}

export class Server extends EventTarget {
  /** The revision of the solution that is shown. */
  shown = 0
  /** How many bytes each revision took that came as what had changed. */
  readonly deltas: number[] = []
  private file?: ArrayBuffer  // of the revision that is shown, while others may follow
  /** Whether others follow, each lit better. */
  solving = false
  private events = new EventSource('events')
  private busy = false
  private lost = false
  private wanted = 0
  private paused = false

  constructor(private show: (solution: Solution) => Promise<void>, private fail: (message: string) => void) {
    super()
    this.events.addEventListener('solution', (event) => {
      this.wanted = Number(event.data)
      void this.load()
    })
    this.events.addEventListener('progress', (event) => this.showProgress(JSON.parse(event.data) as Progress))
    this.events.addEventListener('error', () => this.lose())
    byId('solving-pause').addEventListener('click', () => void this.command(this.paused ? 'resume' : 'pause'))
    byId('solving-stop').addEventListener('click', () => void this.command('stop'))
  }

  /** The program has ended: what is here stays usable. */
  private lose(): void {
    this.lost = true
    this.events.close()
    byId('solving').hidden = true
    if (!this.shown) this.fail('The program has ended before there was anything to show.')
    else notify(`The program has ended${this.solving ? ' before the solve was done: this is how far it came' : ''}. `
      + 'Moving, the lights, readings and pictures still work; the solution cannot be had from this page any more.')
  }

  /** One after the other; what is overtaken meanwhile is skipped. */
  private async load(): Promise<void> {
    if (this.busy) return
    this.busy = true
    try {
      while (this.shown < this.wanted) {
        const { revision, bytes } = await this.fetchRevision()
        await this.show(readSolution(bytes))
        this.file = this.solving ? bytes : undefined
        this.shown = revision
        this.dispatchEvent(new Event('shown'))
      }
    } catch (error) {
      if (this.shown && !this.lost) notifyError(error)
      else if (!this.shown) this.fail(error instanceof Error ? error.message : String(error))
    }
    this.busy = false
  }

  /** What has changed since what is shown, or the whole file. */
  private async fetchRevision(): Promise<{ revision: number; bytes: ArrayBuffer }> {
    if (this.file) {
      const { status, bytes } = await ask(`delta?from=${this.shown}`, {}, 410)
      if (status !== 410) {
        this.deltas.push(bytes.byteLength)
        return applyDelta(this.file, bytes)
      }
    }
    const { headers, bytes } = await ask('solution.glb')
    return { revision: Number(headers.get('ETag')!.slice(1, -1)), bytes }
  }

  private showProgress(progress: Progress): void {
    this.paused = progress.paused
    this.solving = progress.phase !== 'done'
    byId('solving').hidden = progress.phase === 'done'
    byId<HTMLProgressElement>('solving-bar').value = progress.done
    byId('solving-pause').textContent = progress.paused ? 'Resume' : 'Pause'
    byId('solving-text').replaceChildren(element('span', {}, progress.paused ? 'paused' : percent(progress.done)),
      element('span', { class: 'faint' }, ` unshot ${percent(progress.fraction_left)} · ${count(progress.vertices)} vertices`
        + (progress.error === undefined ? '' : ` · error ${fine(progress.error)}`)))
  }

  private async command(command: string): Promise<void> {
    await ask('command', { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify({ command }) }).catch(notifyError)
  }

  /** The program ends when nobody listens any more. */
  leave(): void {
    this.events.close()
  }
}
