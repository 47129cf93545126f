// SPDX-License-Identifier: Apache-2.0
// node --test: who walks is stopped by what reaches from the knees to the crown, and steps on what is lower.
import assert from 'node:assert/strict'
import { describe, it } from 'node:test'
import { near, prepare, visit } from './rooms.mjs'
import { place } from './viewing.mjs'

prepare('hall.glb')

const EYES = 1.6, RADIUS = 0.2  // as in viewer/src/walker.ts

/** Runs from one place towards another till nothing moves any more: where that is, and how high the eyes came. */
async function run(page, from, towards) {
  await page.evaluate(([eye, at]) => {
    const { viewer } = window.exitance
    viewer.movement.setMode('walk')
    viewer.movement.pose = viewer.poseAt(eye, at, 60)
    window.highest = -Infinity
    viewer.addEventListener('drawn', () => (window.highest = Math.max(window.highest, viewer.pose.eye.y)))
  }, [[from[0], EYES, from[1]], [towards[0], EYES, towards[1]]])
  await page.locator('#view').focus()
  for (const key of ['Shift', 'w']) await page.keyboard.down(key)
  let before = from, eye
  for (let i = 0; i < 40; ++i) {
    await page.waitForTimeout(300)
    eye = (await place(page)).eye
    if (i > 1 && Math.hypot(eye[0] - before[0], eye[2] - before[1]) < 1e-3) break
    before = [eye[0], eye[2]]
  }
  for (const key of ['w', 'Shift']) await page.keyboard.up(key)
  return { eye, highest: await page.evaluate(() => window.highest) }
}

describe('on foot', () => {
  it('a table is neither passed nor stepped on', () => visit('hall.glb', async (page) => {
    const { eye: [x, y, z], highest } = await run(page, [1, 1], [7, 1])
    near(x, 3 - RADIUS, 0.01, 'before the table')
    near(y, EYES, 0.01)
    near(z, 1, 0.01)
    near(highest, EYES, 0.01, 'never higher')
  }))

  it('walls are slid along, into the corner', () => visit('hall.glb', async (page) => {
    const { eye: [x, , z] } = await run(page, [1, 6.5], [7, 8.5])
    near(x, 8 - RADIUS, 0.01)
    near(z, 8 - RADIUS, 0.01)
  }))

  it('stairs are climbed', () => visit('hall.glb', async (page) => {
    const { eye: [x, y] } = await run(page, [1, 3], [7, 3])
    near(x, 7.99 - RADIUS, 0.02, 'to the wall')
    near(y, EYES + 4 * 0.18, 0.01, 'four steps of 18 cm')
  }))

  it('30 cm are stepped on, 40 cm are not', () => visit('hall.glb', async (page) => {
    const { eye: [x, y], highest } = await run(page, [1, 5], [7, 5])
    near(highest, EYES + 0.3, 0.02, 'on the step')
    near(x, 6 - RADIUS, 0.01, 'before the chest')
    near(y, EYES, 0.01, 'down again')
  }))

  it('off the ground tables are flown over, walls are not', () => visit('hall.glb', async (page) => {
    await page.click('#gravity')
    const { eye: [x, y] } = await run(page, [1, 1], [7, 1])
    near(x, 8 - RADIUS, 0.01)
    near(y, EYES, 0.01)
  }))

  it('who was put where there is no room gets out', () => visit('hall.glb', async (page) => {
    const { eye: [x] } = await run(page, [2.95, 1], [0, 1])
    near(x, RADIUS, 0.01)
  }))

  it('orbiting passes walls', () => visit('hall.glb', async (page) => {
    await page.evaluate(() => {
      const { viewer } = window.exitance
      viewer.movement.pose = viewer.poseAt([4, 1.6, 7], [4, 1.6, 6.9], 60)
    })
    await page.locator('#view').focus()
    for (let i = 0; i < 12; ++i) await page.keyboard.press('s')
    await page.mouse.move(300, 300)
    for (let i = 0; i < 40; ++i) await page.mouse.wheel(0, 300)
    assert.ok(await page.waitForFunction(() => window.exitance.viewer.pose.eye.z > 8.5))
  }))
})
