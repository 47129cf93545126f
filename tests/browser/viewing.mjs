// SPDX-License-Identifier: Apache-2.0
// The program that serves, a browser that looks, and what both must not do.
import { execFileSync, spawn } from 'node:child_process'
import { mkdtempSync, rmSync } from 'node:fs'
import { createRequire } from 'node:module'
import { tmpdir } from 'node:os'
import { join } from 'node:path'

export const root = process.env.EXITANCE_SOURCE_DIR
export const program = process.env.EXITANCE_PROGRAM
const { chromium } = createRequire(join(root, 'build/node/package.json'))('playwright-core')

export const folder = mkdtempSync(join(tmpdir(), 'viewer-test-'))
export const removeFolder = () => rmSync(folder, { recursive: true })

export function run(...words) {
  return execFileSync(program, words, { cwd: folder, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] })
}

/** Software rendering, so that it is the same everywhere; --no-sandbox because CI runs as root. */
const chromiumAsHere = { executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] }

export const launch = () => chromium.launch(chromiumAsHere)

/** A browser and the number of its first process. */
export async function launchProcess() {
  const server = await chromium.launchServer(chromiumAsHere)
  return { browser: await chromium.connect(server.wsEndpoint()), pid: server.process().pid, close: () => server.close() }
}

/** Serves `file`; ends with `stop()`. */
export async function serve(...words) {
  const process = spawn(program, ['view', ...words, '--no-open', '--quiet'], { cwd: folder, stdio: ['ignore', 'pipe', 'inherit'] })
  const url = await new Promise((resolve, reject) => {
    process.stdout.once('data', (text) => resolve(String(text).trim()))
    process.once('exit', (code) => reject(Error(`view ended with ${code}`)))
  })
  const ended = new Promise((resolve) => process.once('exit', resolve))
  return { url, ended, stop: () => new Promise((resolve) => {
    if (process.exitCode !== null) resolve(process.exitCode)
    process.once('exit', resolve)
    process.kill('SIGINT')
  }) }
}

/** A page that has shown a solution, after the script `init`; `faults` collects what a page may never do. */
export async function open(browser, url, { init, ...options } = {}) {
  const context = await browser.newContext({ viewport: { width: 900, height: 700 }, locale: 'en-GB', ...options })
  if (init) await context.addInitScript(init)
  const page = await context.newPage()
  const faults = []
  page.on('console', (m) => (m.type() === 'error' || m.type() === 'warning') && faults.push(m.text()))
  page.on('pageerror', (error) => faults.push(error.stack))
  page.on('request', (request) => {
    if (!/^(data|blob):/.test(request.url()) && !request.url().startsWith(url.split('#')[0])) faults.push(`asked ${request.url()}`)
  })
  await page.goto(url)
  await page.waitForFunction(() => window.exitance?.viewer.solution && document.getElementById('message').textContent === '',
    null, { timeout: 90000 })
  return { page, faults }
}

export const place = (page) => page.evaluate(() => window.exitance.viewer.place())
export const pose = (page) => page.evaluate(() => {
  const { azimuth, elevation, distance } = window.exitance.viewer.pose
  return { azimuth: azimuth * 180 / Math.PI, elevation: elevation * 180 / Math.PI, distance }
})
/** Linear radiance of a pixel. */
export const radiance = (page, x, y) => page.evaluate(([px, py]) => {
  const { viewer } = window.exitance
  viewer.settle()
  return viewer.stage.radianceAt(viewer.pose, px, py)
}, [x, y])
export const landed = (page) => page.waitForFunction(() => !window.exitance.viewer.movement.flying)
