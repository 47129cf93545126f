// SPDX-License-Identifier: Apache-2.0
// A file from its last revision and what changed since (apps/exitance/byte_delta.h).

const NEW = 0xffffffff

export interface Patched { revision: number; bytes: ArrayBuffer; fresh: number }

/** `fresh`: bytes that were not in the last revision. */
export function applyDelta(before: ArrayBuffer, delta: ArrayBuffer): Patched {
  const view = new DataView(delta)
  if (delta.byteLength < 16 || view.getUint32(0, true) !== 0x314c4458) throw Error('This is no delta.')
  const [revision, size, pieces] = [4, 8, 12].map((at) => view.getUint32(at, true))
  const old = new Uint8Array(before), out = new Uint8Array(size)
  let from = 16 + 8 * pieces, to = 0
  const first = from
  for (let k = 0; k < pieces; ++k) {
    const at = view.getUint32(16 + 8 * k, true), length = view.getUint32(20 + 8 * k, true)
    if (at === NEW) {
      out.set(new Uint8Array(delta, from, length), to)
      from += length
    } else {
      out.set(old.subarray(at, at + length), to)
    }
    to += length
  }
  if (to !== size) throw Error('The delta does not fit.')
  return { revision, bytes: out.buffer, fresh: from - first }
}
