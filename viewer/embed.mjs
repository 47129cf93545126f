// SPDX-License-Identifier: Apache-2.0
// node embed.mjs DIST OUT.cpp: the bundled page as the definition of apps/exitance/viewer_assets.h.
import { readFileSync, readdirSync, writeFileSync } from 'node:fs'
import { join } from 'node:path'

const [folder, output] = process.argv.slice(2)
const types = { html: 'text/html; charset=utf-8', js: 'text/javascript; charset=utf-8',
  css: 'text/css; charset=utf-8' }

const names = readdirSync(folder).sort()
if (names.join() !== 'index.html,viewer.css,viewer.js')
  throw Error(`expected index.html, viewer.css and viewer.js, found ${names}`)

/** A string literal; every other character of a program is kept readable. */
function literal(text) {
  const pieces = []
  for (let i = 0; i < text.length; i += 8000)  // compilers take longer for one long literal
    pieces.push(text.slice(i, i + 8000))
  return pieces.map((piece) => '"' + [...Buffer.from(piece, 'latin1')].map((byte) => {
    const c = String.fromCharCode(byte)
    if (c === '"' || c === '\\' || c === '?') return '\\' + c
    return byte >= 32 && byte < 127 ? c : '\\' + byte.toString(8).padStart(3, '0')
  }).join('') + '"').join('\n        ')
}

const entries = names.map((name) => {
  const bytes = readFileSync(join(folder, name))
  if (bytes.includes('</script', 0) && name.endsWith('.js'))
    throw Error(`${name} has an end of script inside and could not stand in a page`)
  return `    {"${name}", "${types[name.split('.').pop()]}",
     std::string_view(
        ${literal(bytes.toString('latin1'))},
        ${bytes.length})},`
})
writeFileSync(output, `// SPDX-License-Identifier: Apache-2.0
// Written by viewer/embed.mjs.
#include "viewer_assets.h"

namespace exitance::cli {

namespace {
constexpr ViewerAsset assets[] = {
${entries.join('\n')}
};
}  // namespace

std::span<const ViewerAsset> viewer_assets() {
    return assets;
}

}  // namespace exitance::cli
`)
