// SPDX-License-Identifier: Apache-2.0
// node --test: what the page reads agrees with the program's answers.
import assert from 'node:assert/strict'
import { writeFileSync } from 'node:fs'
import { describe, it } from 'node:test'
import { glb, near, prepare, probed, reading, visit } from './rooms.mjs'
import { run } from './viewing.mjs'

prepare('cornell.glb', 'room.glb', 'office.glb')

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
    // What is under it changes when one moves and it rests.
    await page.locator('#view').focus()
    const before = await page.textContent('#read-distance')
    await page.keyboard.press('z')
    await page.waitForFunction((distance) => document.getElementById('read-distance').textContent !== distance, before)
    near(parseFloat(await page.textContent('#read-distance')), (await reading(page, 450, 640)).distance, 1e-3)
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

  it('a section cuts the lines of the mesh and the planes of sensors, too', () => visit('room.glb', async (page) => {
    // From above, all of the room is cut away but its floor: nothing of the walls' lines may be left.
    const drawn = () => page.evaluate(async () => {
      const { viewer } = window.exitance
      viewer.movement.pose = viewer.poseAt([2, 1.2, -0.1], [2, 1.2, -2], 60)
      viewer.settle()
      const copy = new OffscreenCanvas(200, 200).getContext('2d')
      copy.drawImage(await createImageBitmap(await viewer.picture(200, 200)), 0, 0)
      const { data } = copy.getImageData(0, 0, 200, 100), colours = new Set()
      for (let i = 0; i < data.length; i += 4) colours.add(data.slice(i, i + 3).join())
      return colours.size
    })
    await page.click('#wires')
    assert.ok(await drawn() > 20, 'lines on the walls')
    await page.selectOption('#section-axis', { label: 'cut from above' })
    await page.locator('#section-at').evaluate((e) => {
      e.value = 0.02
      e.dispatchEvent(new Event('input'))
    })
    assert.equal(await drawn(), 1, 'the background alone')
    await page.click('#panel-measure summary')
    await page.click('#grids-shown')
    await page.waitForFunction(() => window.exitance.grids.figures.length === 2)
    const work = await page.evaluate(() => {
      const { viewer } = window.exitance
      viewer.movement.pose = viewer.poseAt([2, 2, -1.51], [2, 0, -1.5], 60)
      const read = () => viewer.sensorAt(450, 350)?.grid
      const cut = read()
      viewer.setSection({ axis: -1 })
      return [cut, read()]
    })
    assert.deepEqual(work, ['floor', 'work'])
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

  it('a plane of sensors is what the pointer reads and the tape touches', () => visit('room.glb', async (page) => {
    await page.click('#panel-measure summary')
    await page.click('#grids-shown')
    await page.waitForFunction(() => window.exitance.grids.figures.length === 2)
    // Straight down from 1.2 m above the middle of the first sensor of the second row.
    const seen = await page.evaluate(() => {
      const { viewer } = window.exitance
      viewer.movement.pose = viewer.poseAt([1, 2, -2], [1, 0, -2.0001], 60)
      const { point, ...sensor } = viewer.sensorAt(450, 350)
      return { ...sensor, point: point.toArray() }
    })
    assert.deepEqual([seen.grid, seen.column, seen.row], ['work', 1, 2])
    // The planes lie off their places by 2 mm a metre of the room's diagonal.
    near(seen.point[1], 0.8, 0.02)
    near(seen.distance, 1.2, 0.02)
    near(seen.shares[0] + seen.shares[1], 1, 1e-6)
    const points = '1,0.8,-2,0,1,0\n'
    writeFileSync(glb('sensor.csv'), `x,y,z,nx,ny,nz\n${points}`)
    const [, values] = run('probe', 'room.glb', '--points', 'sensor.csv', '-o', '-', '--method', 'gather').trim().split('\n').map((l) => l.split(',').map(Number))
    const lux = 0.2126 * values[6] + 0.7152 * values[7] + 0.0722 * values[8]
    near(seen.illuminance, lux, 0.02 * lux, 'as probe gathers with other random rays')
    await page.mouse.move(450, 350)
    await page.waitForFunction(() => /^work/.test(document.getElementById('readout').textContent))
    assert.match(await page.textContent('#readout'), /^worksensor 1, row 2Illuminance/)
    near(parseFloat(await page.textContent('#read-irradiance')), seen.illuminance, 0.01 * seen.illuminance)
    near(await page.evaluate(() => window.exitance.viewer.touchAt(450, 350).y), seen.point[1], 1e-6)
    // Below the ceiling lamps nothing hides; from behind a surface the plane is not read.
    assert.equal(await page.evaluate(() => {
      const { viewer } = window.exitance
      viewer.movement.pose = viewer.poseAt([1, 3.5, -2], [1, 0, -2.0001], 60)
      return viewer.sensorAt(450, 350)?.grid
    }), 'work', 'backs of surfaces hide nothing')
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
