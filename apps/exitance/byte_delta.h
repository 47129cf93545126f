// SPDX-License-Identifier: Apache-2.0
// What changed from one revision of a file to the next, as pieces to copy from the old one and
// bytes that are new.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace exitance::cli {

/// A delta, little-endian, as the page reads it (viewer/src/byte_delta.ts):
///
///     "XDL1", uint32 revision that it leads to, uint32 bytes of the new file, uint32 pieces,
///     pieces × { uint32 offset in the old file, or 0xffffffff = new; uint32 bytes },
///     the new bytes of all pieces, in order
///
/// Applying it to `before` gives `after`, byte for byte. Pieces are found by hashes of blocks
/// of `before`, as Tridgell & Mackerras 1996 find them, so that what moved is found as well.
/// Both have fewer than 4 GiB.
std::string make_delta(std::span<const char> before, std::span<const char> after,
                       std::uint32_t revision);

}  // namespace exitance::cli
