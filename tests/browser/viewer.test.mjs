// SPDX-License-Identifier: Apache-2.0
// node --test: the walkthrough does what its controls say, checked against the program's answers.
import assert from 'node:assert/strict'
import { readFileSync, writeFileSync } from 'node:fs'
import { createServer } from 'node:http'
import { join } from 'node:path'
import { after, before, describe, it } from 'node:test'
import { pathToFileURL } from 'node:url'
import { looksAsApproved } from './approved.mjs'
import { makeHeadset } from './headset.mjs'
import { writeLargeSolution } from './large_solution.mjs'
import { folder, landed, launch, open, place, pose, program, radiance, removeFolder, root, run, serve } from './viewing.mjs'

const near = (a, b, tolerance, what) =>
  assert.ok(Math.abs(a - b) <= tolerance, `${what ?? 'value'}: ${a}, expected ${b} within ${tolerance}`)
const glb = (name) => join(folder, name)

let browser
before(async () => {
  run('solve', join(root, 'scenes/cornell.toml'), '-o', 'cornell.glb', '--error', '0.1', '--quiet')
  // Two lamps in groups of their own, a scene that dims them, photometric.
  writeFileSync(glb('room.toml'), `title = "Two lamps"
quantity = "photometric"
[[scenes]]
name = "evening"
left = 0.25
right = 0
[[material]]
name = "wall"
reflectance = 0.6
[[material]]
name = "left lamp"
exitance = 3000
group = "left"
[[material]]
name = "right lamp"
exitance = [2000, 1000, 500]
group = "right"
[[grid]]
name = "work"
origin = [0.5, 0.8, -0.5]
u = [3, 0, 0]
v = [0, 0, -2]
columns = 3
rows = 2
normal = [0, 1, 0]
[[grid]]
name = "floor"
origin = [0.5, 0, -0.5]
u = [3, 0, 0]
v = [0, 0, -2]
columns = 3
rows = 2
normal = [0, 1, 0]
[[camera]]
name = "door"
eye = [0.3, 1.6, -0.3]
look_at = [3, 1, -2]
[[camera]]
name = "window"
eye = [3.5, 1.6, -2.5]
look_at = [0, 0.5, 0]
` + [['floor', 'wall', [[0, 0, 0], [4, 0, 0], [4, 3, 0], [0, 3, 0]]], ['ceiling', 'wall', [[0, 0, 2.5], [0, 3, 2.5], [4, 3, 2.5], [4, 0, 2.5]]],
    ['south', 'wall', [[0, 0, 0], [0, 0, 2.5], [4, 0, 2.5], [4, 0, 0]]], ['north', 'wall', [[0, 3, 0], [4, 3, 0], [4, 3, 2.5], [0, 3, 2.5]]],
    ['west', 'wall', [[0, 0, 0], [0, 3, 0], [0, 3, 2.5], [0, 0, 2.5]]], ['east', 'wall', [[4, 0, 0], [4, 0, 2.5], [4, 3, 2.5], [4, 3, 0]]],
    ['lamp 1', 'left lamp', [[0.8, 1.2, 2.4], [0.8, 1.8, 2.4], [1.4, 1.8, 2.4], [1.4, 1.2, 2.4]]],
    ['lamp 2', 'right lamp', [[2.6, 1.2, 2.4], [2.6, 1.8, 2.4], [3.2, 1.8, 2.4], [3.2, 1.2, 2.4]]]]
    .map(([name, material, corners]) => `[[polygon]]\nname = "${name}"\nmaterial = "${material}"\ncorners = ${JSON.stringify(corners.map(([x, y, z]) => [x, z, -y]))}\n`).join(''))
  run('solve', 'room.toml', '-o', 'room.glb', '--error', '0.1', '--quiet')
  run('solve', join(root, 'scenes/office.toml'), '-o', 'office.glb', '--error', '0.3', '--quiet')
  browser = await launch()
})
after(async () => {
  await browser?.close()
  removeFolder()
})

/** Serves `file`, opens it, and at the end nothing may have gone wrong. */
async function visit(file, look, options) {
  const server = await serve(file)
  try {
    const { page, faults } = await open(browser, server.url, options)
    await look(page, server)
    assert.deepEqual(faults, [])
    await page.context().close()
  } finally {
    await server.stop()
  }
}

/** Irradiance by `exitance probe` where a reading was taken: luminance of its three bands. */
function probed(file, reading) {
  const numbers = [...reading.point, ...reading.normal]
  writeFileSync(glb('point.csv'), `x,y,z,nx,ny,nz\n${numbers.join(',')}\n`)
  const [names, values] = run('probe', file, '--points', 'point.csv', '-o', '-').trim().split('\n').map((l) => l.split(','))
  const value = (name) => Number(values[names.indexOf(name)])
  return 0.2126 * value('E_r') + 0.7152 * value('E_g') + 0.0722 * value('E_b')
}
const reading = (page, x, y) => page.evaluate(([px, py]) => {
  const r = window.exitance.viewer.readAt(px, py)
  return r && { ...r, point: r.point.toArray(), normal: r.normal.toArray() }
}, [x, y])

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

describe('the instrument', () => {
  it('reads what exitance probe says', async () => {
    for (const file of ['cornell.glb', 'room.glb', 'office.glb'])
      await visit(file, async (page) => {
        for (const [x, y] of [[450, 640], [300, 500], [450, 350], [620, 560]]) {
          const found = await reading(page, x, y)
          assert.ok(found, `nothing at ${x}, ${y}`)
          near(found.illuminance, probed(file, found), 0.01 * found.illuminance, `${file} ${found.surface}`)
        }
      })
  })

  it('shows it under the pointer with unit, surface, material and shares', () => visit('room.glb', async (page) => {
    await page.mouse.move(450, 640)
    const found = await reading(page, 450, 640)
    await page.waitForSelector('#readout:not([hidden])')
    const text = await page.textContent('#readout')
    assert.match(text, new RegExp(`^${found.surface}wallIlluminance`))
    const shown = await page.textContent('#read-irradiance')
    near(parseFloat(shown), found.illuminance, 0.01 * found.illuminance)
    assert.match(shown, / lx$/)
    near(parseFloat(await page.textContent('#read-exitance')), 0.6 * found.illuminance, 0.02 * found.illuminance, 'B = rho H')
    near(found.shares[0] + found.shares[1], 1, 1e-6)
    assert.match(text, /left.*%/)
  }))

  it('false colours agree with their legend', () => visit('cornell.glb', async (page) => {
    await page.selectOption('#look', 'illuminance')
    await page.waitForSelector('#legend:not([hidden])')
    const found = await reading(page, 450, 640)
    // The legend's own canvas at the height of the value shows the colour that the pixel has.
    const colours = await page.evaluate(async ([x, y, value]) => {
      const { viewer } = window.exitance, { low, high } = viewer.range
      const scale = document.querySelector('#legend canvas')
      const top = Number(document.querySelector('#legend .scale').dataset.top)
      const row = Math.min(239, Math.floor(240 * (1 - value / top)))
      const legend = scale.getContext('2d').getImageData(0, row, 1, 1).data
      const image = await createImageBitmap(await viewer.picture(viewer.canvas.clientWidth, viewer.canvas.clientHeight))
      const copy = new OffscreenCanvas(image.width, image.height).getContext('2d')
      copy.drawImage(image, 0, 0)
      const marks = [...document.querySelectorAll('#legend .marks span')].map((m) => [Number(m.dataset.value), parseFloat(m.style.bottom)])
      return { legend: [...legend].slice(0, 3), seen: [...copy.getImageData(x, y, 1, 1).data].slice(0, 3), marks, low, high }
    }, [450, 640, found.illuminance])
    colours.legend.forEach((v, c) => near(colours.seen[c], v, 4, 'colour of the legend'))
    for (const [value, bottom] of colours.marks) near(bottom, 100 * (value - colours.low) / (colours.high - colours.low), 0.1)
    const [lower, upper] = await Promise.all(['#legend-low', '#legend-high'].map((id) => page.locator(id).boundingBox()))
    assert.ok(upper.y < lower.y)
    await page.mouse.move(upper.x + 5, upper.y + 7)
    await page.mouse.down()
    await page.mouse.move(upper.x + 5, (upper.y + lower.y) / 2 + 7, { steps: 3 })
    await page.mouse.up()
    near(await page.evaluate(() => window.exitance.viewer.range.high), colours.high / 2, 0.02 * colours.high, 'half way down')
    await page.focus('#legend-low')
    await page.keyboard.press('PageUp')
    assert.ok((await page.evaluate(() => window.exitance.viewer.range.low)) > 0)
    assert.match(await page.getAttribute('#legend-low', 'aria-valuetext'), /^0\.\d+ W/)
    await page.fill('#range-low', '0')
    await page.fill('#range-high', '2')
    await page.press('#range-high', 'Enter')
    assert.deepEqual(await page.evaluate(() => window.exitance.viewer.stage.uniforms.range.value.toArray()), [0, 2])
  }))

  it('contours lie where the illuminance is a multiple of their step', () => visit('cornell.glb', async (page) => {
    // Along a row of pixels of the back wall, the picture changes where a contour is.
    const levels = await page.evaluate(async () => {
      const { viewer } = window.exitance, { canvas } = viewer
      const row = async () => {
        viewer.settle()
        const copy = new OffscreenCanvas(canvas.clientWidth, canvas.clientHeight).getContext('2d')
        copy.drawImage(await createImageBitmap(await viewer.picture(canvas.clientWidth, canvas.clientHeight)), 0, 0)
        return copy.getImageData(0, 300, canvas.clientWidth, 1).data
      }
      const plain = await row()
      viewer.setContour(0.1)
      const lined = await row(), found = []
      for (let x = 340; x < 560; ++x)
        if (Math.abs(lined[4 * x] - plain[4 * x]) > 60) found.push(viewer.readAt(x + 0.5, 300.5).illuminance / 0.1)
      return found
    })
    assert.ok(levels.length >= 2, `${levels}`)
    for (const level of levels) near(level, Math.round(level), 0.2, 'multiple of the step')
  }))

  it('a section shows what is behind', () => visit('cornell.glb', async (page) => {
    const front = await reading(page, 560, 560)
    await page.selectOption('#section-axis', { label: 'cut along' })
    await page.click('#section-flip')
    const behind = await reading(page, 560, 560)
    assert.ok(behind.distance > front.distance || behind.surface !== front.surface)
  }))
})

/** Means over a grid of six sensors by `exitance probe`. */
function meanOfGrid(height, method) {
  const points = [0, 1].flatMap((j) => [0, 1, 2].map((i) => [0.5 + i + 0.5, height, -0.5 - (j + 0.5), 0, 1, 0].join()))
  writeFileSync(glb('grid.csv'), `x,y,z,nx,ny,nz\n${points.join('\n')}\n`)
  const [, ...rows] = run('probe', 'room.glb', '--points', 'grid.csv', '-o', '-', '--method', method).trim().split('\n').map((l) => l.split(',').map(Number))
  const lux = rows.map((r) => 0.2126 * r[6] + 0.7152 * r[7] + 0.0722 * r[8])
  return { mean: lux.reduce((a, b) => a + b, 0) / 6, min: Math.min(...lux) }
}

describe('measuring', () => {
  it('sensor grids, on a surface and in free space, follow the lights', () => visit('room.glb', async (page) => {
    await page.click('#panel-measure summary')
    await page.click('#grids-shown')
    await page.waitForFunction(() => window.exitance.grids.figures.length === 2)
    const read = () => page.evaluate(() => window.exitance.grids.figures)
    const all = await read()
    // Both sides gather with random rays: 256 here, about 0.6 %, and 1024 there.
    for (const [k, height, method] of [[0, 0.8, 'gather'], [1, 0, 'interpolate']]) {
      const truth = meanOfGrid(height, method)
      near(all[k].mean, truth.mean, 0.02 * truth.mean, all[k].name)
      near(all[k].min, truth.min, 0.03 * truth.min, all[k].name)
      near(all[k].uniformity, all[k].min / all[k].mean, 1e-9)
    }
    await page.click('#solo-0')
    const left = await read()
    await page.click('#solo-0')
    await page.click('#mute-0')
    const right = await read()
    near(left[0].mean + right[0].mean, all[0].mean, 1e-3 * all[0].mean)
    assert.match(await page.textContent('#grid-figures'), /work/)
    assert.equal(await page.locator('#labels .point').count(), 12)
  }))

  it('the tape', () => visit('room.glb', async (page) => {
    await page.click('#panel-measure summary')
    await page.click('#tape')
    await page.mouse.click(300, 600)
    await page.waitForTimeout(500)
    await page.mouse.click(500, 600)
    const [length, a, b] = await page.evaluate(() => [window.exitance.tape.length,
      ...[[300, 600], [500, 600]].map(([x, y]) => window.exitance.viewer.pickAt(x, y).point.toArray())])
    near(length, Math.hypot(...a.map((v, i) => v - b[i])), 1e-6)
    assert.match(await page.textContent('#labels'), new RegExp(`^${length.toFixed(3)} m$`))
  }))
})

describe('movement', () => {
  it('the keys of radview', () => visit('cornell.glb', async (page) => {
    await page.locator('#view').focus()
    const start = await pose(page), at = await place(page)
    const after = async (key) => {
      await page.keyboard.press(key)
      return pose(page)
    }
    near((await after('ArrowLeft')).azimuth - start.azimuth, -1, 1e-6, 'azimuth by 1 degree')
    near((await after('ArrowRight')).azimuth - start.azimuth, 0, 1e-6)
    near(Math.abs((await after('ArrowUp')).elevation - start.elevation), 1, 1e-6, 'elevation by 1 degree')
    near((await after('ArrowDown')).elevation - start.elevation, 0, 1e-6)
    near((await after('z')).distance, 0.95 * start.distance, 1e-6, 'zoom in')
    near((await after('x')).distance, start.distance, 1e-6, 'zoom out')
    await page.keyboard.press('a')
    const along = await place(page)
    near(along.eye[2] - at.eye[2], 0.05 * start.distance, 1e-4, 'viewpoint along the sight')
    near(along.look_at[2] - at.look_at[2], 0.05 * start.distance, 1e-4, 'reference along the sight')
    await page.keyboard.press('s')
    near((await place(page)).eye[2], at.eye[2], 1e-4)
    await page.keyboard.press('z')
    await page.keyboard.press('r')
    await landed(page)
    near((await pose(page)).distance, start.distance, 1e-6, 'reset')
    await page.keyboard.press('F1')
    assert.ok(await page.locator('#help').isVisible())
    await page.keyboard.press('F2')
    assert.ok(!(await page.locator('#help').isVisible()))
  }))

  it('a drag turns about the reference point, the wheel comes nearer', () => visit('cornell.glb', async (page) => {
    const start = await pose(page), at = await place(page)
    await page.mouse.move(400, 300)
    await page.mouse.down()
    await page.mouse.move(470, 300, { steps: 4 })
    await page.mouse.up()
    const dragged = await place(page)
    near(Math.abs((await pose(page)).azimuth - start.azimuth), 18, 0.5, '70 of 700 pixels: a tenth of 180 degrees')
    dragged.look_at.forEach((v, i) => near(v, at.look_at[i], 1e-4, 'reference'))
    await page.mouse.wheel(0, -100)
    await page.waitForFunction((d) => window.exitance.viewer.pose.distance < d, start.distance)
    near((await pose(page)).distance, start.distance * Math.exp(-0.1), 1e-3)
  }))

  it('on foot: W walks, Shift runs, walls stop, feet find the ground', () => visit('room.glb', async (page) => {
    await page.click('#walk')
    await page.waitForFunction(() => Math.abs(window.exitance.viewer.pose.eye.y - window.exitance.viewer.movement.eyeHeight) < 0.01)
    const walked = async (...keys) => {
      const from = await place(page)
      for (const key of keys) await page.keyboard.down(key)
      await page.waitForTimeout(400)
      for (const key of keys.reverse()) await page.keyboard.up(key)
      const to = await place(page)
      return Math.hypot(to.eye[0] - from.eye[0], to.eye[2] - from.eye[2])
    }
    const there = await walked('w')
    assert.ok(there > 0.1, `walked ${there} m`)
    await page.keyboard.down('w')
    await page.keyboard.down('Shift')
    await page.waitForTimeout(3000)
    await page.keyboard.up('Shift')
    await page.keyboard.up('w')
    const { eye } = await place(page)
    assert.ok(eye[0] > 0 && eye[0] < 4 && eye[2] < 0 && eye[2] > -3, `walls stop: ${eye}`)
    near(eye[1], 1.6, 0.02, 'height of the eyes')
  }))

  it('bookmarks fly there, a double click goes there, a link says where', () => visit('room.glb', async (page, server) => {
    await page.click('#camera-1')
    await landed(page)
    const there = await place(page)
    ;[3.5, 1.6, -2.5].forEach((v, i) => near(there.eye[i], v, 1e-4, 'eye of the second camera'))
    await page.click('#panel-save summary')
    await page.click('#link')
    await page.waitForFunction(() => location.hash.includes('eye='))
    const link = page.url()
    await page.mouse.dblclick(300, 400)
    await landed(page)
    const moved = await place(page)
    assert.ok(Math.hypot(...moved.eye.map((v, i) => v - there.eye[i])) > 0.5)
    const other = await open(browser, link)
    const again = await place(other.page)
    ;[3.5, 1.6, -2.5].forEach((v, i) => near(again.eye[i], v, 1e-3, 'eye of the link'))
    assert.ok(link.startsWith(server.url))
    await other.page.context().close()
  }))
})

describe('by itself', () => {
  it('automatic flies through the places until somebody moves', () => visit('room.glb', async (page) => {
    await page.click('#automatic')
    // It begins at the first camera and comes by the second.
    const near = (x, y, z) => page.waitForFunction(([a, b, c]) => {
      const { eye } = window.exitance.viewer.pose
      return Math.hypot(eye.x - a, eye.y - b, eye.z - c) < 0.15
    }, [x, y, z], { timeout: 20000, polling: 50 })
    await near(0.3, 1.6, -0.3)
    await page.evaluate(() => (window.exitance.viewer.movement.advanceTime(3)))
    await near(3.5, 1.6, -2.5)
    await page.locator('#view').focus()
    await page.keyboard.press('ArrowLeft')
    assert.equal(await page.isChecked('#automatic'), false)
    const there = await place(page)
    await page.waitForTimeout(300)
    assert.deepEqual(await place(page), there)
  }))

  it('right click opens a menu: manual or automatic', () => visit('room.glb', async (page) => {
    await page.mouse.click(300, 400, { button: 'right' })
    assert.ok(await page.locator('#menu').isVisible())
    assert.equal(await page.evaluate(() => document.activeElement.id), 'menu-manual')
    await page.keyboard.press('ArrowDown')
    await page.keyboard.press('Enter')
    assert.ok(await page.evaluate(() => window.exitance.viewer.movement.automatic))
    assert.equal(await page.evaluate(() => document.activeElement.id), 'view')
    await page.keyboard.press('Shift+F10')
    assert.equal(await page.getAttribute('#menu-automatic', 'aria-checked'), 'true')
    await page.keyboard.press('Escape')
    assert.ok(!(await page.locator('#menu').isVisible()))
    await page.mouse.click(300, 400, { button: 'right' })
    await page.click('#menu-keep')
    assert.equal(await page.locator('#bookmarks button').count(), 1)
    await page.mouse.click(300, 400, { button: 'right' })
    await page.mouse.click(300, 300)
    assert.ok(!(await page.locator('#menu').isVisible()), 'a click elsewhere closes it')
  }))

  it('a click turns to a place and from then on about it', () => visit('cornell.glb', async (page) => {
    const [eye, point] = [(await place(page)).eye, (await reading(page, 300, 450)).point]
    await page.mouse.click(300, 450)
    await page.waitForFunction(() => window.exitance.viewer.movement.flying)
    await landed(page)
    const there = await place(page)
    there.eye.forEach((v, i) => near(v, eye[i], 1e-4, 'eye'))
    there.look_at.forEach((v, i) => near(v, point[i], 1e-3, 'what is looked at'))
  }))

  it('a gamepad and two fingers', () => visit('room.glb', async (page) => {
    const start = await place(page)
    await page.evaluate(() => {
      window.pad = { connected: true, axes: [0, -1, 0, 0] }
      navigator.getGamepads = () => [window.pad]
    })
    await page.waitForFunction(([x, , z]) => Math.hypot(window.exitance.viewer.pose.eye.x - x, window.exitance.viewer.pose.eye.z - z) > 0.1, start.eye)
    await page.evaluate(() => (window.pad.axes = [0, 0, 0.5, 0]))
    const { azimuth } = await pose(page)
    await page.waitForFunction((a) => Math.abs(window.exitance.viewer.pose.azimuth * 180 / Math.PI - a) > 2, azimuth)
    await page.evaluate(() => (window.pad.axes = [0, 0, 0, 0]))
    const before = await pose(page)
    await page.evaluate(() => {
      const send = (type, pointerId, x) => window.exitance.viewer.canvas.dispatchEvent(
        new PointerEvent(type, { pointerId, pointerType: 'touch', clientX: x, clientY: 300, buttons: 1, bubbles: true }))
      send('pointerdown', 1, 300)
      send('pointerdown', 2, 400)
      send('pointermove', 2, 500)
      send('pointerup', 1, 300)
      send('pointerup', 2, 500)
    })
    near((await pose(page)).distance, before.distance / 2, 1e-6, 'fingers twice as far apart: half as far away')
  }))
})

describe('a headset', () => {
  it('is not offered where there is none', () => visit('room.glb', async (page) => {
    assert.ok(!(await page.locator('#headset').isVisible()))
  }))

  it('enters where one stood; sticks walk, turn and teleport; leaving looks where one looked', () => visit('room.glb', async (page) => {
    const start = await place(page)
    await page.click('#headset')
    await page.waitForFunction(() => window.headset.frames > 3)
    assert.equal(await page.getAttribute('#headset', 'aria-pressed'), 'true')
    assert.deepEqual(await page.evaluate(() => window.headset.asked), { mode: 'immersive-vr', wishes: { requiredFeatures: ['local-floor'] } })
    const state = () => page.evaluate(() => {
      const { rig, camera } = window.exitance.viewer.stage
      const way = camera.getWorldDirection(rig.position.clone())
      const head = rig.localToWorld(rig.position.clone().set(...window.headset.head))
      return { feet: rig.position.toArray(), head: head.toArray(), way: way.toArray(), turn: rig.rotation.y }
    })
    const entered = await state()
    near(entered.feet[0], start.eye[0], 1e-4)
    near(entered.feet[1], 0, 1e-3, 'the floor')
    near(entered.head[1], 1.6, 1e-3, 'the height of the head is the wearer\'s')
    near(Math.atan2(-entered.way[0], -entered.way[2]), Math.atan2(-(start.look_at[0] - start.eye[0]), -(start.look_at[2] - start.eye[2])), 1e-3)
    // Both eyes see the lit room.
    const eyes = await page.evaluate(async () => {
      const { stage } = window.exitance.viewer, gl = stage.renderer.getContext()
      await new Promise((resolve) => stage.renderer.xr.getSession().requestAnimationFrame(resolve))
      const pixel = (x) => {
        const out = new Uint8Array(4)
        gl.readPixels(x, 100, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, out)
        return out[0] + out[1] + out[2]
      }
      const { camera } = stage
      stage.renderer.render(stage.scene, camera)
      return [pixel(100), pixel(300)]
    })
    assert.ok(eyes.every((light) => light > 60), `${eyes}`)

    await page.evaluate(() => window.headset.sources.push({ handedness: 'left', gamepad: { axes: [0, 0, 0, -1] } }))
    await page.waitForFunction(([x, , z]) => {
      const { x: a, z: b } = window.exitance.viewer.stage.rig.position
      return Math.hypot(a - x, b - z) > 0.2
    }, entered.feet)
    const walked = await state()
    const by = [0, 2].map((c) => walked.feet[c] - entered.feet[c]), length = Math.hypot(...by)
    near(by[0] / length, entered.way[0] / Math.hypot(entered.way[0], entered.way[2]), 1e-3, 'along the sight')
    await page.evaluate(() => {
      window.exitance.viewer.movement.speed = 40
      window.framesThen = window.headset.frames
    })
    await page.waitForFunction(() => window.headset.frames > window.framesThen + 20)
    const { head } = await state()
    assert.ok(head[0] > 0 && head[0] < 4 && head[2] < 0 && head[2] > -3, `walls stop: ${head}`)

    await page.evaluate(() => (window.headset.sources = [{ handedness: 'right', gamepad: { axes: [0, 0, 1, 0] } }]))
    const facing = await state()
    await page.waitForFunction((t) => Math.abs(window.exitance.viewer.stage.rig.rotation.y - t) > 0.1, facing.turn)
    await page.waitForTimeout(200)
    near((await state()).turn - facing.turn, -Math.PI / 6, 1e-6, 'once, by 30 degrees')

    const after = await state()
    await page.click('#headset')
    await page.waitForFunction(() => document.getElementById('headset').getAttribute('aria-pressed') === 'false')
    const back = await place(page)
    back.eye.forEach((v, i) => near(v, after.head[i], 1e-3, 'where one left'))
    assert.deepEqual(await page.evaluate(() => window.exitance.viewer.stage.rig.position.toArray()), [0, 0, 0])
  }, { init: makeHeadset }))

  it('teleports to the floor that is pointed at, and nowhere else', () => visit('room.glb', async (page) => {
    await page.click('#headset')
    await page.waitForFunction(() => window.headset.frames > 3)
    const point = (slope) => page.evaluate(async (tilt) => {
      const { rig } = window.exitance.viewer.stage
      rig.position.set(2, 0, -1.5)
      rig.rotation.y = 0
      const [c, s] = [Math.cos(tilt), Math.sin(tilt)]
      const source = { handedness: 'right', gamepad: { axes: [0, 0, 0, -1] }, targetRaySpace: [1, 0, 0, 0, 0, c, -s, 0, 0, s, c, 0, 0, 1, 0, 1] }
      window.headset.sources = [source]
      const frames = (n) => new Promise((resolve) => {
        const start = window.headset.frames
        const wait = () => (window.headset.frames > start + n ? resolve() : setTimeout(wait, 10))
        wait()
      })
      await frames(3)
      source.gamepad.axes = [0, 0, 0, 0]
      await frames(3)
      return rig.position.toArray()
    }, slope)
    // From 1 m up, 45 degrees down: 1 m ahead.
    const [x, , z] = await point(Math.PI / 4)
    near(x, 2, 1e-3)
    near(z, -2.5, 1e-2)
    const [a, , b] = await point(-0.2)
    near(a, 2, 1e-3, 'a wall is nowhere to stand')
    near(b, -1.5, 1e-3)
  }, { init: makeHeadset }))
})

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
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390)
    await page.click('#panel-toggle')
    assert.ok(await page.locator('#weight-0').isVisible())
  }, { viewport: { width: 390, height: 780 }, locale: 'de-DE' }))
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

/** The bytes of a file by the names of their views. */
function views(path) {
  const file = readFileSync(path), length = file.readUInt32LE(12), json = JSON.parse(file.subarray(20, 20 + length).toString())
  return Object.fromEntries(json.bufferViews.map((view) => {
    const start = 28 + length + (view.byteOffset ?? 0)
    return [view.name, file.subarray(start, start + view.byteLength)]
  }))
}

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

describe('live', () => {
  it('a scene grows before one\'s eyes and ends as the file on disk', async () => {
    const server = await serve(join(root, 'scenes/cornell.toml'), '--error', '0.007', '-o', 'grown.glb')
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

assert.ok(program, 'EXITANCE_PROGRAM names the program')
