// SPDX-License-Identifier: Apache-2.0
// node --test: the page looks as approved, serves the keyboard alone, and shows large solutions.
import assert from 'node:assert/strict'
import { describe, it } from 'node:test'
import { looksAsApproved } from './approved.mjs'
import { writeLargeSolution } from './large_solution.mjs'
import { glb, near, prepare, visit } from './rooms.mjs'

prepare('cornell.glb', 'room.glb', 'office.glb')

describe('looks', () => {
  /** Shows `file` and lets it come to rest. */
  const pictured = (file, name, options, prepare) => visit(file, async (page) => {
    await prepare?.(page)
    await page.waitForFunction(() => !window.exitance.viewer.movement.flying)
    await page.evaluate(() => window.exitance.viewer.settle())
    await page.waitForTimeout(300)
    await looksAsApproved(page, name)
  }, options)

  it('as approved: the office, dark', () => pictured('office.glb', 'office', { viewport: { width: 1100, height: 700 }, colorScheme: 'dark' },
    (page) => page.mouse.move(500, 440)))
  it('as approved: false colours and contours, light', () => pictured('cornell.glb', 'false_colour',
    { viewport: { width: 1100, height: 700 }, colorScheme: 'light' }, async (page) => {
      await page.selectOption('#look', 'illuminance')
      await page.click('#contours')
    }))
  it('as approved: a phone, German', () => pictured('office.glb', 'phone',
    { viewport: { width: 390, height: 780 }, colorScheme: 'light', locale: 'de-DE' }, async (page) => {
      await page.click('#panel-toggle')
      await page.mouse.move(180, 300)
    }))
  it('as approved: the mesh by level, the help', () => pictured('cornell.glb', 'help',
    { viewport: { width: 1100, height: 700 }, colorScheme: 'dark' }, async (page) => {
      await page.click('#wires')
      await page.locator('#view').focus()
      await page.keyboard.press('F1')
    }))

  it('no pinhole is left where surfaces meet', () => visit('office.glb', async (page) => {
    // From inside a closed room nothing but surfaces is seen: pixels that nothing covers, with the rims and without.
    const open = await page.evaluate(() => {
      const { viewer } = window.exitance, { stage } = viewer, { eye } = viewer.place()
      stage.meter.setSize(1200, 800)
      const uncovered = () => {
        let found = 0
        for (let turn = 0; turn < 12; ++turn) {
          const angle = 2 * Math.PI * turn / 12
          viewer.movement.pose = viewer.poseAt(eye, [eye[0] + Math.cos(angle), eye[1] + 0.1, eye[2] + Math.sin(angle)], 60)
          viewer.settle()
          found += stage.measure(stage.meter).reduce((n, v, i) => n + (i % 4 === 3 && v < 1 ? 1 : 0), 0)
        }
        return found
      }
      const closed = uncovered()
      for (const mesh of stage.mesh.children) for (const rims of mesh.children) rims.visible = false
      return [closed, uncovered()]
    })
    assert.equal(open[0], 0)
    assert.ok(open[1] > 0, 'there would be some')
  }))

  it('the keyboard alone: every stop is seen, none is a trap, panels widen', () => visit('room.glb', async (page) => {
    await page.locator('#view').focus()
    const stops = []
    for (let i = 0; i < 80; ++i) {
      await page.keyboard.press('Tab')
      const stop = await page.evaluate(() => {
        const { activeElement: e } = document, box = e.getBoundingClientRect()
        return { id: e.id || e.textContent, tag: e.tagName, seen: box.width > 0 && box.height > 0, outlined: getComputedStyle(e).outlineStyle }
      })
      if (stop.tag === 'BODY' || stop.id === 'view') break
      stops.push(stop)
    }
    const ids = stops.map((s) => s.id)
    assert.equal(new Set(ids).size, ids.length, `once each: ${ids}`)
    assert.ok(stops.length > 20 && stops.length < 80, `${stops.length} stops, then round`)
    for (const stop of stops) assert.ok(stop.seen && stop.outlined !== 'none', `${stop.id} shows that it has the focus`)
    const order = ['orbit', 'help-open', 'panel-toggle', 'weight-0', 'exposure-automatic', 'look', 'gravity'].map((id) => ids.indexOf(id))
    assert.deepEqual(order, [...order].sort((a, b) => a - b), `as they stand: ${ids}`)
    assert.ok(order.every((at) => at >= 0), `${ids}`)
    const width = () => page.evaluate(() => document.getElementById('panel').clientWidth)
    const before = await width()
    await page.focus('#panel-edge')
    await page.keyboard.press('ArrowLeft')
    near(await width(), before + 16, 1)
    assert.equal(Number(await page.getAttribute('#panel-edge', 'aria-valuenow')), await width() + 2)
    // Sliders, switches and the way of moving.
    await page.focus('#weight-0')
    await page.keyboard.press('Home')
    assert.equal((await page.evaluate(() => window.exitance.viewer.mix.groups[0])).weight, 0)
    await page.focus('#mute-1')
    await page.keyboard.press('Space')
    assert.equal(await page.getAttribute('#mute-1', 'aria-pressed'), 'true')
    await page.focus('#orbit')
    await page.keyboard.press('ArrowRight')
    assert.equal(await page.evaluate(() => window.exitance.viewer.movement.mode), 'walk')
    await page.focus('#help-open')
    await page.keyboard.press('Enter')
    await page.keyboard.press('Escape')
    assert.ok(!(await page.locator('#help').isVisible()))
    assert.equal(await page.evaluate(() => document.activeElement.id), 'help-open', 'back where one was')
  }))

  it('every control has a name and Tab finds it', () => visit('room.glb', async (page) => {
    const nameless = await page.evaluate(() => [...document.querySelectorAll('button, input, select, canvas#view')].filter((e) =>
      !(e.getAttribute('aria-label') || e.textContent.trim() || e.closest('label')?.textContent.trim())).map((e) => e.outerHTML))
    assert.deepEqual(nameless, [])
    await page.locator('#view').focus()
    const stops = []
    for (let i = 0; i < 12; ++i) {
      await page.keyboard.press('Tab')
      stops.push(await page.evaluate(() => document.activeElement.id || document.activeElement.tagName))
    }
    assert.ok(stops.includes('weight-0') && stops.includes('help-open'), stops.join(' '))
  }))

  it('numbers as German writes them, at the size of a phone', () => visit('room.glb', async (page) => {
    assert.ok(!(await page.locator('#panel').isVisible()))
    await page.mouse.move(180, 500)
    await page.waitForSelector('#readout:not([hidden])')
    assert.match(await page.textContent('#read-distance'), /^\d+,\d+ m$/)
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 360)
    await page.click('#panel-toggle')
    assert.ok(await page.locator('#weight-0').isVisible())
    await page.click('#panel-toggle')
    const shown = await page.textContent('#read-distance')
    await page.touchscreen.tap(100, 300)
    await page.waitForFunction((before) => document.getElementById('read-distance')?.textContent !== before, shown)
    assert.ok(await page.locator('#readout').isVisible(), 'a tap reads, and the reading stays')
    await page.click('#help-open')
    assert.equal(await page.evaluate(() => document.getElementById('help').scrollTop), 0, 'help begins at its beginning')
    await page.keyboard.press('Escape')
    // The title and what is said while a scene is being lit have room, and nothing lies over them.
    assert.ok(await page.locator('#title').isVisible())
    await page.evaluate(() => {
      document.getElementById('solving').hidden = false
      document.getElementById('solving-text').textContent = '13 % unshot 44 % · 1.470.062 vertices · error 12,3 %'
    })
    const [solving, read, ...within] = await Promise.all(['#solving', '#readout', '#title', '#solving-pause', '#solving-stop', '#solving-text']
      .map((id) => page.locator(id).boundingBox()))
    for (const box of [solving, ...within]) assert.ok(box.x >= 0 && box.x + box.width <= 360, JSON.stringify(box))
    assert.ok(read.y >= solving.y + solving.height)
  }, { viewport: { width: 360, height: 740 }, locale: 'de-DE', hasTouch: true }))
})

describe('size', () => {
  it('a million triangles with eight groups open, and a slider shows in the next frames', async (test) => {
    assert.ok(writeLargeSolution(glb('large.glb'), glb('cornell.glb'), 708, 8) > 1e6)
    const start = performance.now()
    await visit('large.glb', async (page) => {
      const opened = (performance.now() - start) / 1000
      const frames = await page.evaluate(() => new Promise((resolve) => {
        const { viewer } = window.exitance
        let count = 0
        const next = () => { ++count; requestAnimationFrame(next) }
        viewer.addEventListener('drawn', () => resolve(count), { once: true })
        viewer.mix.set(0, { weight: 0.3 })
        requestAnimationFrame(next)
      }))
      const heap = await page.evaluate(() => performance.memory.usedJSHeapSize / 2 ** 20)
      test.diagnostic(`opened in ${opened.toFixed(1)} s, ${heap.toFixed(0)} MiB of heap`)
      assert.ok(frames <= 2, `${frames} frames`)
      // Alone on two cores it takes 3 s; other tests run beside it.
      assert.ok(opened < 30, `${opened} s`)
    })
  })
})
