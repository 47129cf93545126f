// SPDX-License-Identifier: Apache-2.0
// node --test: keys, pointers, flights and headsets move the eye as they say.
import assert from 'node:assert/strict'
import { describe, it } from 'node:test'
import { makeHeadset } from './headset.mjs'
import { browser, near, prepare, reading, visit } from './rooms.mjs'
import { landed, open, place, pose } from './viewing.mjs'

prepare('cornell.glb', 'room.glb')

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

    await page.evaluate(() => (window.headset.sources = []))
    const facing = await state()
    await page.evaluate(() => (window.headset.sources = [{ handedness: 'right', gamepad: { axes: [0, 0, 1, 0] } }]))
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
