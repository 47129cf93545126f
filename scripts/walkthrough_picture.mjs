// SPDX-License-Identifier: Apache-2.0
// A picture of the walkthrough, with the pointer on something to read:
// node scripts/walkthrough_picture.mjs SOLUTION.glb OUT.png
import { spawn } from 'node:child_process'
import { createRequire } from 'node:module'
import { dirname, join } from 'node:path'
import { fileURLToPath } from 'node:url'

const root = dirname(dirname(fileURLToPath(import.meta.url)))
const { chromium } = createRequire(join(root, 'build/node/package.json'))('playwright-core')
const [solution, picture] = process.argv.slice(2)
if (!picture) throw Error('usage: node scripts/walkthrough_picture.mjs SOLUTION.glb OUT.png')

const view = spawn(join(root, 'build/bin/exitance'), ['view', solution, '--no-open', '--quiet'],
  { stdio: ['ignore', 'pipe', 'inherit'] })
try {
  const url = await new Promise((resolve, reject) => {
    view.stdout.once('data', (text) => resolve(String(text).trim()))
    view.once('exit', (code) => reject(Error(`view ended with ${code}`)))
  })
  // Software rendering, so that it is the same everywhere; browsers refuse a sandbox to root.
  const browser = await chromium.launch({ executablePath: '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] })
  const page = await browser.newPage({ viewport: { width: 1200, height: 750 }, colorScheme: 'dark', locale: 'en-GB' })
  await page.goto(url)
  await page.waitForFunction(() => window.exitance?.viewer.solution && document.getElementById('message').textContent === '')
  await page.mouse.move(480, 470)
  await page.waitForSelector('#readout:not([hidden])', { timeout: 5000 }).catch(() => {})  // nothing is there
  await page.evaluate(() => window.exitance.viewer.settle())
  await page.screenshot({ path: picture })
  await browser.close()
} finally {
  view.kill('SIGINT')
}
