// SPDX-License-Identifier: Apache-2.0
// node --test: the light is mixed, exposed and added up as it should be.
import assert from 'node:assert/strict'
import { readFileSync } from 'node:fs'
import { describe, it } from 'node:test'
import { writeLargeSolution } from './large_solution.mjs'
import { glb, near, prepare, reading, visit } from './rooms.mjs'
import { radiance, run } from './viewing.mjs'

prepare('cornell.glb', 'room.glb')

describe('light', () => {
  it('half a slider is half a pixel, and other groups keep theirs', () => visit('room.glb', async (page) => {
    const at = [450, 600]
    const set = (g, v) => page.locator(`#weight-${g}`).evaluate((e, value) => {
      e.value = value
      e.dispatchEvent(new Event('input'))
    }, v)
    const both = await radiance(page, ...at)
    await set(1, 0)
    const left = await radiance(page, ...at)
    await set(0, 0.5)
    const half = await radiance(page, ...at)
    await set(0, 0)
    await set(1, 1)
    const right = await radiance(page, ...at)
    for (let c = 0; c < 3; ++c) {
      assert.ok(left[c] > 0 && right[c] > 0)
      near(half[c], left[c] / 2, 0.01 * left[c], 'half of the left lamp')
      near(left[c] + right[c], both[c], 0.001 * both[c], 'sum of the lamps')
    }
  }))

  it('solo, mute and colour', () => visit('room.glb', async (page) => {
    const at = [450, 600], both = await radiance(page, ...at)
    await page.click('#solo-0')
    const left = await radiance(page, ...at)
    await page.click('#solo-0')
    await page.click('#mute-0')
    const right = await radiance(page, ...at)
    for (let c = 0; c < 3; ++c) near(left[c] + right[c], both[c], 0.001 * both[c])
    await page.click('#mute-0')
    await page.locator('#colour-0').fill('#ff0000')
    const tinted = await radiance(page, ...at)
    near(tinted[0], both[0], 0.001 * both[0], 'red passes')
    near(tinted[2], right[2], 0.001 * right[2], 'of the left lamp no blue does')
  }))

  it('a named scene is what probe --scene says, after a cross-fade', () => visit('room.glb', async (page) => {
    const before = await reading(page, 450, 600)
    await page.selectOption('#scene', { label: 'evening' })
    await page.waitForFunction(() => !window.exitance.viewer.mix.fading)
    const after = await reading(page, 450, 600)
    near(after.illuminance, before.illuminance * before.shares[0] * 0.25, 1e-3 * after.illuminance)
    near(after.shares[1], 0, 1e-6)
    assert.equal(await page.inputValue('#weight-0'), '0.25')
  }))
})

describe('exposure', () => {
  it('shows what exitance render shows, by each tone curve', () => visit('cornell.glb', async (page) => {
    for (const curve of ['reinhard', 'filmic', 'linear']) {
      run('render', 'cornell.glb', '-o', 'rendered.png', '--size', '300x300', '--tone', curve)
      const apart = await page.evaluate(async ([png, tone]) => {
        const { viewer } = window.exitance
        viewer.setToneCurve(tone)
        viewer.settle()
        const bytes = Uint8Array.from(atob(png), (c) => c.charCodeAt(0))
        const pixels = async (blob) => {
          const context = new OffscreenCanvas(300, 300).getContext('2d')
          context.drawImage(await createImageBitmap(blob), 0, 0)
          return context.getImageData(0, 0, 300, 300).data
        }
        const [theirs, ours] = [await pixels(new Blob([bytes])), await pixels(await viewer.picture(300, 300))]
        return theirs.reduce((sum, v, i) => sum + Math.abs(v - ours[i]), 0) / theirs.length
      }, [readFileSync(glb('rendered.png')).toString('base64'), curve])
      // Meters at another resolution, and the background differs: a few of 255 levels.
      assert.ok(apart < 4, `${curve}: ${apart} levels apart`)
    }
  }, { viewport: { width: 300, height: 300 }, colorScheme: 'dark' }))

  it('automatic follows the light, a fixed EV does not', () => visit('room.glb', async (page) => {
    const ev = () => page.evaluate(() => {
      window.exitance.viewer.settle()
      return window.exitance.viewer.ev
    })
    const bright = await ev()
    await page.evaluate(() => [0, 1].forEach((g) => window.exitance.viewer.mix.set(g, { weight: 0.5 })))
    near(await ev(), bright - 1, 0.01, 'half the light is one EV less')
    await page.locator('#exposure-ev').evaluate((e) => {
      e.value = 3
      e.dispatchEvent(new Event('input'))
    })
    near(await ev(), 3, 1e-6)
    assert.ok(!(await page.isChecked('#exposure-automatic')))
    assert.equal(await page.evaluate(() => window.exitance.viewer.stage.uniforms.exposure.value), 1 / (1.2 * 2 ** 3))
  }))
})

describe('many light groups', () => {
  it('beyond what a vertex carries, all count', async () => {
    writeLargeSolution(glb('many.glb'), glb('cornell.glb'), 20, 30)
    await visit('many.glb', async (page) => {
      const at = [450.5, 350.5], all = await radiance(page, ...at), seen = await reading(page, ...at)
      near(all[1], 0.9 / (0.2126 + 0.7152 * 0.9 + 0.0722 * 0.7) * seen.exitance / Math.PI, 0.01 * all[1], 'all thirty')
      for (const g of [3, 11, 12, 29]) {
        await page.click(`#solo-${g}`)
        const [, one] = await radiance(page, ...at)
        near(one / all[1], seen.shares[g], 0.01 * seen.shares[g] + 1e-5, `lamp ${g + 1}`)
        await page.click(`#solo-${g}`)
      }
      assert.deepEqual(await radiance(page, ...at), all)
    })
  })
})
