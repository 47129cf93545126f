// SPDX-License-Identifier: Apache-2.0
// Pictures in files, as textures need them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "exitance/scene/texture.h"

namespace exitance {

struct ImageSizeInFile {
    std::uint64_t width = 0, height = 0;
};

/// Size of a PNG or JPEG from its first bytes. Throws std::runtime_error that says what is wrong.
ImageSizeInFile image_size(std::string_view bytes);

/// Decodes a PNG or JPEG; 16 bits become 8, grey becomes RGB, transparency is left out. Throws
/// std::runtime_error that says what is wrong.
TexturePicture decode_image(std::string_view bytes);

/// A PNG of the picture; the same picture gives the same bytes.
std::string encode_png(const TexturePicture& picture);

}  // namespace exitance
