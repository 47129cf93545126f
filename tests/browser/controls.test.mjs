// SPDX-License-Identifier: Apache-2.0
// node --test: every control does what it says, what is taken away is right, and strangers get nothing.
import assert from 'node:assert/strict'
import { readFileSync } from 'node:fs'
import { createServer } from 'node:http'
import { describe, it } from 'node:test'
import { pathToFileURL } from 'node:url'
import { browser, glb, near, prepare, probed, reading, visit } from './rooms.mjs'
import { landed, open, place, pose, run, serve } from './viewing.mjs'

prepare('cornell.glb', 'room.glb')

describe('every control', () => {
  const uniform = (page, name) => page.evaluate((n) => window.exitance.viewer.stage.uniforms[n].value, name)

  it('looks, mesh, contours, range', () => visit('cornell.glb', async (page) => {
    for (const [look, number] of [['exitance', 2], ['normals', 3], ['reflectance', 4], ['picture', 0]]) {
      await page.selectOption('#look', look)
      assert.equal(await uniform(page, 'look'), number)
    }
    await page.selectOption('#tone', 'filmic')
    assert.equal(await uniform(page, 'toneCurve'), 2)
    await page.click('#contours')
    const step = Number(await page.inputValue('#contour-step'))
    assert.ok(step > 0)
    assert.equal(await uniform(page, 'contour'), step)
    await page.click('#contours')
    assert.equal(await uniform(page, 'contour'), 0)
    const picture = () => page.evaluate(async () => {
      const { viewer } = window.exitance
      viewer.settle()
      const text = await (await viewer.picture(100, 100)).arrayBuffer()
      return new Uint8Array(text).reduce((sum, v) => (sum * 31 + v) % 1000003, 7)
    })
    const plain = await picture()
    await page.click('#wires')
    assert.notEqual(await picture(), plain, 'the mesh is drawn')
    assert.match(await page.textContent('#levels'), /^012/, 'levels of subdivision')
    await page.click('#wires')
    assert.equal(await picture(), plain)
    await page.selectOption('#look', 'illuminance')
    await page.fill('#range-low', '0.5')
    await page.press('#range-low', 'Enter')
    assert.equal((await page.evaluate(() => window.exitance.viewer.range)).low, 0.5)
    await page.click('#range-fit')
    assert.deepEqual(await page.evaluate(() => [window.exitance.viewer.range.low, window.exitance.viewer.range.automatic]), [0, true])
  }))

  it('reflectance and normals are those of the scene', () => visit('cornell.glb', async (page) => {
    const pixel = (look) => page.evaluate(async (name) => {
      const { viewer } = window.exitance
      viewer.setLook(name)
      const context = new OffscreenCanvas(900, 700).getContext('2d')
      context.drawImage(await createImageBitmap(await viewer.picture(900, 700)), 0, 0)
      return [...context.getImageData(250, 665, 1, 1).data].slice(0, 3)
    }, look)
    assert.equal((await reading(page, 250, 665)).surface, 'floor')
    const encoded = (v) => 255 * (1.055 * v ** (1 / 2.4) - 0.055)
    ;(await pixel('reflectance')).forEach((v, c) => near(v, encoded([0.725, 0.71, 0.68][c]), 2, 'white paint'))
    ;(await pixel('normals')).forEach((v, c) => near(v, [127.5, 255, 127.5][c], 2, 'up'))
  }))

  it('sliding, rising, automatic', () => visit('room.glb', async (page) => {
    const at = await place(page)
    await page.mouse.move(400, 300)
    await page.mouse.down({ button: 'right' })
    await page.mouse.move(440, 300, { steps: 3 })
    await page.mouse.up({ button: 'right' })
    const slid = await place(page)
    const by = slid.eye.map((v, i) => v - at.eye[i])
    assert.ok(Math.hypot(...by) > 0.01)
    slid.look_at.forEach((v, i) => near(v - at.look_at[i], by[i], 1e-4, 'the reference slides along'))
    const before = await pose(page)
    await page.click('#automatic')
    await page.waitForFunction((a) => Math.abs(window.exitance.viewer.pose.azimuth * 180 / Math.PI - a) > 2, before.azimuth)
    await page.click('#automatic')
    await page.click('#walk')
    await page.click('#gravity')
    await page.locator('#view').focus()
    const low = (await place(page)).eye[1]
    await page.keyboard.down('e')
    await page.waitForFunction((y) => window.exitance.viewer.pose.eye.y > y + 0.1, low)
    await page.keyboard.up('e')
    await page.click('#bookmark')
    await page.click('#reset')
    await landed(page)
    await page.click('#bookmarks button')
    await landed(page)
    assert.ok((await place(page)).eye[1] > low + 0.09)
  }))

  it('Esc twice ends the visit and the program', async () => {
    const server = await serve('cornell.glb')
    const { page, faults } = await open(browser, server.url)
    await page.locator('#view').focus()
    await page.keyboard.press('Escape')
    await page.keyboard.press('Escape')
    assert.match(await page.textContent('#message'), /ended/)
    assert.equal(await server.ended, 0)
    assert.ok(await reading(page, 450, 640), 'the page goes on')
    assert.deepEqual(faults, [])
    await page.context().close()
  })
})

describe('numbers that cannot be', () => {
  it('are not taken, and the user is told', () => visit('room.glb', async (page) => {
    await page.click('#panel-save summary')
    const given = async (id, text) => {
      await page.fill(id, text)
      await page.press(id, 'Enter')
      const said = await page.evaluate(() => (document.getElementById('notice').hidden ? '' : document.getElementById('notice-text').textContent))
      await page.evaluate(() => (document.getElementById('notice').hidden = true))
      return [await page.inputValue(id), said]
    }
    for (const wrong of ['0', '-5', '20000', '1e9', '']) {
      const [kept, said] = await given('#picture-width', wrong)
      assert.equal(kept, '1920')
      assert.match(said, /at least 16 and at most 16384; it stays 1920/)
    }
    assert.deepEqual(await given('#picture-width', '640.4'), ['640', ''])
    const [step] = await given('#contour-step', '25')
    assert.equal(step, '25')
    for (const wrong of ['0', '-3', '']) {
      const [kept, said] = await given('#contour-step', wrong)
      assert.equal(kept, '25')
      assert.match(said, /more than 0; it stays 25/)
    }
    await page.click('#contours')
    assert.equal(await page.evaluate(() => window.exitance.viewer.contour), 25)
    await page.selectOption('#look', 'illuminance')
    const [low, high] = await page.evaluate(() => [window.exitance.viewer.range.low, window.exitance.viewer.range.high])
    assert.match((await given('#range-low', String(high + 1)))[1], /less than/)
    assert.match((await given('#range-high', '-1'))[1], /more than/)
    assert.deepEqual(await page.evaluate(() => [window.exitance.viewer.range.low, window.exitance.viewer.range.high]), [low, high])
  }))
})

describe('the program ends', () => {
  it('and the page says so, goes on, and tells what it cannot have any more', async () => {
    const server = await serve('room.glb'), { page, faults } = await open(browser, server.url)
    await server.stop()
    await page.waitForSelector('#notice:not([hidden])')
    const said = () => page.textContent('#notice-text')
    assert.match(await said(), /^The program has ended/)
    await page.click('#notice-close')
    assert.ok(!(await page.locator('#notice').isVisible()))
    for (const [panel, control] of [['#panel-save', '#solution-file'], ['#panel-measure', '#grids-shown']]) {
      await page.click(`${panel} summary`)
      await page.click(control)
      await page.waitForSelector('#notice:not([hidden])')
      assert.match(await said(), /does not answer/)
      await page.click('#notice-close')
    }
    assert.ok(!(await page.isChecked('#grids-shown')))
    await page.click('#solo-0')
    assert.ok(await reading(page, 450, 640), 'reads')
    const [picture] = await Promise.all([page.waitForEvent('download'), page.click('#picture')])
    assert.equal(readFileSync(await picture.path()).readUInt32BE(16), 1920)
    // The browser itself notes on its console which requests found nobody.
    assert.deepEqual(faults.filter((fault) => !/Failed to load resource|ERR_/.test(fault)), [])
    await page.context().close()
  })
})

describe('taking away', () => {
  it('a picture of any size, and the mix as a model', () => visit('cornell.glb', async (page) => {
    await page.click('#panel-save summary')
    await page.fill('#picture-width', '320')
    await page.press('#picture-width', 'Tab')
    await page.fill('#picture-height', '200')
    await page.press('#picture-height', 'Tab')
    const [picture] = await Promise.all([page.waitForEvent('download'), page.click('#picture')])
    const png = readFileSync(await picture.path())
    assert.equal(png.readUInt32BE(16), 320)
    assert.equal(png.readUInt32BE(20), 200)
    const [model] = await Promise.all([page.waitForEvent('download'), page.click('#export')])
    await model.saveAs(glb('mix.glb'))
    assert.match(run('info', 'mix.glb'), /triangles|polygons/)
  }))

  it('a picture larger than graphics cards draw is what a small one shows, in more pixels', () => visit('cornell.glb', async (page) => {
    const apart = await page.evaluate(async () => {
      const { viewer } = window.exitance
      viewer.settle()
      const pixels = async (width, height) => {
        const context = new OffscreenCanvas(450, 350).getContext('2d', { willReadFrequently: true })
        context.drawImage(await createImageBitmap(await viewer.picture(width, height)), 0, 0, 450, 350)
        return context.getImageData(0, 0, 450, 350).data
      }
      const [small, large] = [await pixels(450, 350), await pixels(4500, 3500)]
      return small.reduce((sum, v, i) => sum + Math.abs(v - large[i]), 0) / small.length
    })
    assert.ok(apart < 2, `${apart} levels of 255 apart: edges alone`)
    assert.equal(await page.evaluate(() => window.exitance.viewer.stage.renderer.domElement.width), 900, 'the page is as it was')
  }))

  it('the solution itself', () => visit('room.glb', async (page) => {
    await page.click('#panel-save summary')
    const [file] = await Promise.all([page.waitForEvent('download'), page.click('#solution-file')])
    assert.ok(readFileSync(await file.path()).equals(readFileSync(glb('room.glb'))))
  }))

  it('one file that works from disk, without network', async () => {
    run('view', 'cornell.glb', '--html', 'cornell.html')
    const { page, faults } = await open(browser, pathToFileURL(glb('cornell.html')).href, { offline: true })
    const found = await reading(page, 450, 640)
    near(found.illuminance, probed('cornell.glb', found), 0.01 * found.illuminance)
    assert.deepEqual(faults, [])
    await page.context().close()
  })
})

describe('strangers', () => {
  it('a page of another site gets nothing', async () => {
    const server = await serve('cornell.glb')
    const site = createServer((_, answer) => answer.setHeader('Content-Type', 'text/html').end('<p>elsewhere</p>'))
    await new Promise((resolve) => site.listen(0, '127.0.0.1', resolve))
    const context = await browser.newContext(), page = await context.newPage()
    await page.goto(`http://127.0.0.1:${site.address().port}/`)
    const got = await page.evaluate(async (url) => {
      const tried = (promise) => promise.then((v) => v, () => 'refused')
      const loaded = (tag, attributes) => new Promise((resolve) => {
        const node = Object.assign(document.createElement(tag), attributes)
        node.onload = () => resolve(tag === 'iframe' ? (node.contentDocument ? 'readable' : 'refused') : 'loaded')
        node.onerror = () => resolve('refused')
        document.body.append(node)
      })
      return { read: await tried(fetch(`${url}solution.glb`).then((a) => a.status)),
        command: await tried(fetch(`${url}command`, { method: 'POST', mode: 'no-cors', body: '{"command": "stop"}' }).then((a) => a.type)),
        script: await loaded('script', { src: `${url}viewer.js` }), frame: await loaded('iframe', { src: url }) }
    }, server.url)
    assert.deepEqual(got, { read: 'refused', command: 'refused', script: 'refused', frame: 'refused' })
    assert.match(page.frames()[1].url(), /^chrome-error:/, 'nobody frames the page')
    await context.close()
    site.close()
    await server.stop()
  })

  it('the page itself can ask nobody else', async () => {
    const heard = []
    const site = createServer((request, answer) => {
      heard.push(request.url)
      answer.setHeader('Access-Control-Allow-Origin', '*').end('x')
    })
    await new Promise((resolve) => site.listen(0, '127.0.0.1', resolve))
    const server = await serve('cornell.glb'), { page } = await open(browser, server.url)
    const violated = await page.evaluate(async (elsewhere) => {
      const out = []
      addEventListener('securitypolicyviolation', (event) => out.push(event.effectiveDirective))
      await fetch(`${elsewhere}/asked`).catch(() => {})
      new Image().src = `${elsewhere}/picture`
      document.body.append(Object.assign(document.createElement('script'), { src: `${elsewhere}/script` }),
        Object.assign(document.createElement('script'), { textContent: 'window.ran = true' }))
      document.body.append(Object.assign(document.createElement('iframe'), { src: elsewhere }))
      await new Promise((resolve) => setTimeout(resolve, 300))
      return { out: [...new Set(out)].sort(), ran: window.ran }
    }, `http://127.0.0.1:${site.address().port}`)
    assert.deepEqual(violated, { out: ['connect-src', 'frame-src', 'img-src', 'script-src-elem'], ran: undefined })
    assert.deepEqual(heard, [])
    await page.context().close()
    site.close()
    await server.stop()
  })
})
