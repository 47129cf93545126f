// SPDX-License-Identifier: Apache-2.0
// node --test: a scene grows in the page while it is being lit.
import assert from 'node:assert/strict'
import { readFileSync } from 'node:fs'
import { join } from 'node:path'
import { describe, it } from 'node:test'
import { browser, glb, near, prepare, probed, reading } from './rooms.mjs'
import { open, root, serve } from './viewing.mjs'

prepare()

/** The bytes of a file by the names of their views. */
function views(path) {
  const file = readFileSync(path), length = file.readUInt32LE(12), json = JSON.parse(file.subarray(20, 20 + length).toString())
  return Object.fromEntries(json.bufferViews.map((view) => {
    const start = 28 + length + (view.byteOffset ?? 0)
    return [view.name, file.subarray(start, start + view.byteLength)]
  }))
}

describe('live', () => {
  it('a scene grows before one\'s eyes and ends as the file on disk', async () => {
    const server = await serve(join(root, 'scenes/cornell.toml'), '--solver', 'shooting', '--error', '0.007', '-o', 'grown.glb')
    try {
      const { page, faults } = await open(browser, server.url)
      await page.evaluate(() => {
        window.sizes = []
        window.exitance.server.addEventListener('shown', () => window.sizes.push(window.exitance.viewer.solution.indices.length / 3))
      })
      await page.waitForFunction(() => window.exitance.server.shown >= 3, null, { timeout: 120000 })
      assert.ok(await page.evaluate(() => window.exitance.viewer.solution.unshot?.some((v) => v > 0) ?? window.exitance.viewer.solution.error), 'what is unshot')
      await page.click('#solving-stop', { timeout: 5000 }).catch(() => {}) // or it is done already
      await page.waitForFunction(() => document.getElementById('solving').hidden, null, { timeout: 120000 })
      const last = await page.evaluate(() => new Promise((resolve) => {
        const done = () => resolve({ shown: window.exitance.server.shown, sizes: window.sizes, deltas: window.exitance.server.deltas })
        setTimeout(done, 1500)
      }))
      assert.ok(last.shown >= 3, `states shown: ${last.shown}`)
      assert.ok(last.deltas.length >= 2, 'what changed was asked for')
      const onDisk = views(glb('grown.glb'))
      const held = await page.evaluate(() => {
        const { positions, exitance } = window.exitance.viewer.solution
        return [positions, exitance[0]].map((values) => [...new Uint8Array(values.buffer, values.byteOffset, values.byteLength)])
      })
      ;['POSITION', '_EXITANCE_0'].forEach((name, i) => assert.ok(onDisk[name].equals(Buffer.from(held[i])), `${name} is that of the file`))
      assert.ok(last.sizes.every((size, i) => i === 0 || size >= last.sizes[i - 1] || i === last.sizes.length - 1), `${last.sizes}`)
      assert.deepEqual(faults, [])
      const found = await reading(page, 450, 640)
      near(found.illuminance, probed('grown.glb', found), 0.01 * found.illuminance)
      await page.context().close()
    } finally {
      await server.stop()
    }
  })
})
