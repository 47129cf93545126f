// SPDX-License-Identifier: Apache-2.0
// Pictures that somebody has looked at and approved, in tests/browser/approved: EXITANCE_APPROVE=1
// replaces them by what is seen now, to be looked at.
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs'
import { join } from 'node:path'
import { root } from './viewing.mjs'

// Lit anew by another solver a picture may change a little everywhere; text may move by a pixel.
const LEVELS = 24, SHARE = 0.02

/** Whether the page looks as approved; else says by how much, and leaves what it saw. */
export async function looksAsApproved(page, name) {
  const file = join(root, 'tests/browser/approved', `${name}.png`), seen = await page.screenshot({ animations: 'disabled' })
  if (process.env.EXITANCE_APPROVE) writeFileSync(file, seen)
  if (!existsSync(file)) throw Error(`${file} is missing`)
  const share = await page.evaluate(async ([a, b, levels]) => {
    const pixels = async (text) => {
      const image = await createImageBitmap(new Blob([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))]))
      const context = new OffscreenCanvas(image.width, image.height).getContext('2d')
      context.drawImage(image, 0, 0)
      return context.getImageData(0, 0, image.width, image.height)
    }
    const [x, y] = [await pixels(a), await pixels(b)]
    if (x.width !== y.width || x.height !== y.height) return 1
    let apart = 0
    for (let i = 0; i < x.data.length; i += 4)
      if ([0, 1, 2].some((c) => Math.abs(x.data[i + c] - y.data[i + c]) > levels)) ++apart
    return apart / (x.width * x.height)
  }, [readFileSync(file).toString('base64'), seen.toString('base64'), LEVELS])
  if (share <= SHARE) return
  const folder = join(root, 'build/browser')
  mkdirSync(folder, { recursive: true })
  writeFileSync(join(folder, `${name}.png`), seen)
  throw Error(`${(100 * share).toFixed(1)} % of the pixels of ${name} differ from ${file}; seen: ${folder}`)
}
