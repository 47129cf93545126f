// SPDX-License-Identifier: Apache-2.0
// node benchmarks/view/large.mjs CELLS GROUPS: what the walkthrough takes to show 2 x CELLS x CELLS
// triangles with so many light groups. Times are of the wall: the page is what one waits for.
import { readdirSync, readFileSync, statSync } from 'node:fs'
import { join } from 'node:path'
import { writeLargeSolution } from '../../tests/browser/large_solution.mjs'
import { folder, launchProcess, open, removeFolder, root, run, serve } from '../../tests/browser/viewing.mjs'

const [cells, groups] = process.argv.slice(2).map(Number)

/** Proportional set size of a process and all below it [bytes]. */
function memory(pid) {
  const parents = new Map(readdirSync('/proc').filter((name) => /^\d+$/.test(name)).map((name) => {
    try {
      return [Number(name), Number(readFileSync(`/proc/${name}/stat`, 'utf8').split(') ')[1].split(' ')[1])]
    } catch {
      return [Number(name), 0]  // it has ended
    }
  }))
  const below = (p) => [p, ...[...parents].filter(([, parent]) => parent === p).flatMap(([child]) => below(child))]
  return below(pid).reduce((sum, p) => {
    try {
      return sum + 1024 * Number(readFileSync(`/proc/${p}/smaps_rollup`, 'utf8').match(/^Pss:\s+(\d+)/m)[1])
    } catch {
      return sum
    }
  }, 0)
}

run('solve', join(root, 'scenes/cornell.toml'), '-o', 'cornell.glb', '--error', '0.5', '--quiet')
const file = join(folder, 'large.glb'), triangles = writeLargeSolution(file, join(folder, 'cornell.glb'), cells, groups)
const { browser, pid, close } = await launchProcess(), empty = memory(pid)
const server = await serve(file), start = performance.now()
const { page } = await open(browser, server.url)
const open_seconds = (performance.now() - start) / 1000
const slider = await page.evaluate(() => new Promise((resolve) => {
  const { viewer } = window.exitance
  let frames = 0, begin = 0
  const count = () => {
    ++frames
    requestAnimationFrame(count)
  }
  viewer.addEventListener('drawn', () => {
    viewer.stage.renderer.getContext().finish()  // what is drawn is there
    resolve({ frames, seconds: (performance.now() - begin) / 1000 })
  }, { once: true })
  requestAnimationFrame(() => {
    viewer.stage.renderer.getContext().finish()
    begin = performance.now()
    viewer.mix.set(0, { weight: 0.3 })
    requestAnimationFrame(count)
  })
}))
const page_bytes = await page.evaluate(() => {
  const { solution } = window.exitance.viewer
  const arrays = [solution.positions, solution.normals, solution.indices, ...solution.exitance, ...solution.irradiance]
  return arrays.reduce((sum, a) => sum + a.byteLength, 0)
})
console.log(JSON.stringify({ triangles, groups, file_bytes: statSync(file).size, open_seconds, slider_frames: slider.frames,
  slider_seconds: slider.seconds, page_bytes, browser_bytes: memory(pid) - empty }))
await close()
await server.stop()
removeFolder()
