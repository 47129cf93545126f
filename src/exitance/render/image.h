// SPDX-License-Identifier: Apache-2.0
// A picture of linear RGB values, Rec. 709 primaries, and the files it goes into.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "exitance/math/vector.h"

namespace exitance {

struct Image {
    std::uint32_t width = 0, height = 0;
    std::vector<Vec3f> pixels;  ///< rows from the top

    Image() = default;
    Image(std::uint32_t w, std::uint32_t h) : width(w), height(h), pixels(std::size_t{w} * h) {}
    Vec3f& at(std::uint32_t x, std::uint32_t y) { return pixels[std::size_t{y} * width + x]; }
    const Vec3f& at(std::uint32_t x, std::uint32_t y) const {
        return pixels[std::size_t{y} * width + x];
    }
};

enum class ImageFormat {
    png,  ///< 8 bits, sRGB: what a screen shows
    exr,  ///< OpenEXR, float: linear values
    hdr   ///< Radiance RGBE: linear values, about 1 % steps
};

/// By the ending of the name. Throws Error(wrong_use) for others than .png, .exr and .hdr.
ImageFormat image_format(const std::filesystem::path& path);

/// Display value 0 … 1 of a linear value (IEC 61966-2-1), clipped.
float srgb_encoded(float linear);

/// Writes `image` whole or not at all; PNG clips it to 0 … 1. Throws Error(could_not_finish) if it
/// cannot be written, Error(wrong_use) for an unknown ending.
void write_image(const Image& image, const std::filesystem::path& path);

}  // namespace exitance
