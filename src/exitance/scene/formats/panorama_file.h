// SPDX-License-Identifier: Apache-2.0
// Pictures of the whole surroundings as they are in .hdr and .exr files.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "exitance/scene/read_options.h"

namespace exitance {

struct Panorama {
    std::size_t width = 0, height = 0;
    std::vector<float> pixels;  ///< rows from the top, three bands, from 0 to 1e30
    const float* at(std::size_t x, std::size_t y) const { return &pixels[3 * (y * width + x)]; }
};

// Both throw std::runtime_error that says what is wrong, and set nothing aside for pixels that the
// bytes cannot hold.

/// Decodes a Radiance picture (.hdr).
Panorama decode_hdr(std::string_view bytes, const ReadOptions& options);

/// Decodes an OpenEXR picture (.exr). Not safe against hostile files: to be called within
/// contained_call().
Panorama decode_exr(std::string_view bytes, const ReadOptions& options);

}  // namespace exitance
