// SPDX-License-Identifier: Apache-2.0
// Solved rooms to walk through, a browser, and what the program itself says about them.
import assert from 'node:assert/strict'
import { writeFileSync } from 'node:fs'
import { join } from 'node:path'
import { after, before } from 'node:test'
import { folder, launch, open, removeFolder, root, run, serve } from './viewing.mjs'

export const near = (a, b, tolerance, what) =>
  assert.ok(Math.abs(a - b) <= tolerance, `${what ?? 'value'}: ${a}, expected ${b} within ${tolerance}`)
export const glb = (name) => join(folder, name)

/** The browser of the tests that ask for rooms. */
export let browser

const solvers = {
  'cornell.glb': () => run('solve', join(root, 'scenes/cornell.toml'), '-o', 'cornell.glb', '--solver', 'shooting', '--error', '0.1', '--quiet'),
  'office.glb': () => run('solve', join(root, 'scenes/office.toml'), '-o', 'office.glb', '--error', '0.3', '--quiet'),
  'room.glb': () => {
    writeTwoLamps()
    run('solve', 'room.toml', '-o', 'room.glb', '--error', '0.1', '--quiet')
  },
  'hall.glb': () => {
    writeHall()
    run('solve', 'hall.toml', '-o', 'hall.glb', '--error', '0.5', '--quiet')
  },
}

/** Solves them before the tests of a file. */
export function prepare(...names) {
  before(async () => {
    for (const name of names) solvers[name]()
    browser = await launch()
  })
  after(async () => {
    await browser?.close()
    removeFolder()
  })
}

const polygon = (name, material, corners) => `[[polygon]]\nname = "${name}"\nmaterial = "${material}"\ncorners = ${JSON.stringify(corners)}\n`

/** The sides of a box between two corners, seen from outside; or those of a room. */
function box(name, material, [x, y, z], [X, Y, Z], isRoom = false) {
  const sides = { east: [[X, y, Z], [X, y, z], [X, Y, z], [X, Y, Z]], west: [[x, y, z], [x, y, Z], [x, Y, Z], [x, Y, z]],
    top: [[x, Y, Z], [X, Y, Z], [X, Y, z], [x, Y, z]], bottom: [[x, y, z], [X, y, z], [X, y, Z], [x, y, Z]],
    south: [[x, y, Z], [X, y, Z], [X, Y, Z], [x, Y, Z]], north: [[X, y, z], [x, y, z], [x, Y, z], [X, Y, z]] }
  return Object.entries(sides).map(([side, corners]) => polygon(`${name} ${side}`, material, isRoom ? corners.reverse() : corners)).join('')
}
const lampAt = (name, material, x, y, z, size) =>
  polygon(name, material, [[x, y, z], [x + size, y, z], [x + size, y, z + size], [x, y, z + size]])

/** A room with two lamps in groups of their own and a scene that dims them, photometric. */
function writeTwoLamps() {
  const grid = (name, height) => `[[grid]]
name = "${name}"
origin = [0.5, ${height}, -0.5]
u = [3, 0, 0]
v = [0, 0, -2]
columns = 3
rows = 2
normal = [0, 1, 0]
`
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
${grid('work', 0.8)}${grid('floor', 0)}[[camera]]
name = "door"
eye = [0.3, 1.6, -0.3]
look_at = [3, 1, -2]
[[camera]]
name = "window"
eye = [3.5, 1.6, -2.5]
look_at = [0, 0.5, 0]
${box('room', 'wall', [0, 0, -3], [4, 2.5, 0], true)}${lampAt('lamp 1', 'left lamp', 0.8, 2.4, -1.8, 0.6)}${lampAt('lamp 2', 'right lamp', 2.6, 2.4, -1.8, 0.6)}`)
}

/** A hall with things to walk against: a table, stairs, a low step and a chest. */
function writeHall() {
  const stairs = [1, 2, 3, 4].map((k) => box(`step ${k}`, 'wall', [3 + 0.28 * (k - 1), 0, 2.4], [7.99, 0.18 * k, 3.6])).join('')
  writeFileSync(glb('hall.toml'), `[[material]]
name = "wall"
reflectance = 0.6
[[material]]
name = "lamp"
exitance = 100
${box('hall', 'wall', [0, 0, 0], [8, 3, 8], true)}${lampAt('lamp', 'lamp', 3, 2.9, 3, 2)}${stairs}${box('table', 'wall', [3, 0.72, 0.4], [4, 0.75, 1.6])}
${box('low', 'wall', [3, 0, 4.4], [4, 0.3, 5.6])}${box('chest', 'wall', [6, 0, 4.4], [7, 0.4, 5.6])}`)
}

/** Serves `file`, opens it, looks at the page, and at the end nothing may have gone wrong. */
export async function visit(file, look, options) {
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
export function probed(file, reading) {
  const numbers = [...reading.point, ...reading.normal]
  writeFileSync(glb('point.csv'), `x,y,z,nx,ny,nz\n${numbers.join(',')}\n`)
  const [names, values] = run('probe', file, '--points', 'point.csv', '-o', '-').trim().split('\n').map((l) => l.split(','))
  const value = (name) => Number(values[names.indexOf(name)])
  return 0.2126 * value('E_r') + 0.7152 * value('E_g') + 0.0722 * value('E_b')
}
export const reading = (page, x, y) => page.evaluate(([px, py]) => {
  const r = window.exitance.viewer.readAt(px, py)
  return r && { ...r, point: r.point.toArray(), normal: r.normal.toArray() }
}, [x, y])
