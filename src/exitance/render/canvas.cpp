// SPDX-License-Identifier: Apache-2.0
#include "exitance/render/canvas.h"

#include <stb/stb_truetype.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "exitance/render/font.h"

namespace exitance {

namespace {

const stbtt_fontinfo& font() {
    static const stbtt_fontinfo info = [] {
        stbtt_fontinfo loaded{};
        stbtt_InitFont(&loaded, legend_font(), 0);
        return loaded;
    }();
    return info;
}

/// Code points of UTF-8; a broken byte stands for itself.
std::vector<int> code_points(const std::string& text) {
    std::vector<int> out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const std::size_t more = byte >= 0xf0 ? 3 : byte >= 0xe0 ? 2 : byte >= 0xc0 ? 1 : 0;
        int code = more == 0 ? byte : byte & (0x3f >> more);
        if (i + more >= text.size() && more > 0) break;
        for (std::size_t k = 1; k <= more; ++k)
            code = code << 6 | (static_cast<unsigned char>(text[i + k]) & 0x3f);
        out.push_back(code);
        i += more;
    }
    return out;
}

/// Calls `place(code point, x)` for each glyph; returns where the text ends.
template <class Place>
double lay_out(const std::string& text, double size, const Place& place) {
    const double scale = double(stbtt_ScaleForPixelHeight(&font(), static_cast<float>(size)));
    double x = 0;
    int previous = 0;
    for (const int code : code_points(text)) {
        if (previous) x += scale * stbtt_GetCodepointKernAdvance(&font(), previous, code);
        place(code, x);
        int advance = 0, bearing = 0;
        stbtt_GetCodepointHMetrics(&font(), code, &advance, &bearing);
        x += scale * advance;
        previous = code;
    }
    return x;
}

}  // namespace

void Canvas::blend(std::int64_t x, std::int64_t y, const Vec3f& colour, double opacity) {
    if (x < 0 || y < 0 || x >= image_.width || y >= image_.height || !(opacity > 0)) return;
    Vec3f& pixel = image_.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
    pixel = pixel + (colour - pixel) * static_cast<float>(std::min(opacity, 1.0));
}

void Canvas::fill(double left, double top, double right, double bottom, const Vec3f& colour,
                  double opacity) {
    const auto overlap = [](double low, double high, std::int64_t i) {
        return std::clamp(std::min(high, double(i + 1)) - std::max(low, double(i)), 0.0, 1.0);
    };
    left = std::max(left, 0.0), top = std::max(top, 0.0);
    right = std::min(right, double(image_.width)), bottom = std::min(bottom, double(image_.height));
    for (auto y = static_cast<std::int64_t>(top); y < bottom; ++y)
        for (auto x = static_cast<std::int64_t>(left); x < right; ++x)
            blend(x, y, colour, opacity * overlap(left, right, x) * overlap(top, bottom, y));
}

void Canvas::line(double x0, double y0, double x1, double y1, double width, const Vec3f& colour,
                  double opacity) {
    const double reach = 0.5 * width + 1, dx = x1 - x0, dy = y1 - y0;
    const double square = std::max(dx * dx + dy * dy, 1e-12);
    const auto clipped = [](double v, std::uint32_t size) {
        return static_cast<std::int64_t>(std::clamp(std::floor(v), -1.0, double(size)));
    };
    for (auto y = clipped(std::min(y0, y1) - reach, image_.height);
         y <= clipped(std::max(y0, y1) + reach, image_.height); ++y)
        for (auto x = clipped(std::min(x0, x1) - reach, image_.width);
             x <= clipped(std::max(x0, x1) + reach, image_.width); ++x) {
            const double px = double(x) + 0.5 - x0, py = double(y) + 0.5 - y0;
            const double along = std::clamp((px * dx + py * dy) / square, 0.0, 1.0);
            const double distance = std::hypot(px - along * dx, py - along * dy);
            blend(x, y, colour, opacity * std::clamp(0.5 * width + 0.5 - distance, 0.0, 1.0));
        }
}

void Canvas::text(double x, double y, double size, const std::string& text, const Vec3f& colour) {
    const float scale = stbtt_ScaleForPixelHeight(&font(), static_cast<float>(size));
    std::vector<unsigned char> bitmap;
    lay_out(text, size, [&](int code, double offset) {
        const double left = std::floor(x + offset), baseline = std::floor(y);
        const auto shift_x = static_cast<float>(x + offset - left);
        const auto shift_y = static_cast<float>(y - baseline);
        int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
        stbtt_GetCodepointBitmapBoxSubpixel(&font(), code, scale, scale, shift_x, shift_y, &x0, &y0,
                                            &x1, &y1);
        if (x1 <= x0 || y1 <= y0) return;
        bitmap.assign(static_cast<std::size_t>(x1 - x0) * static_cast<std::size_t>(y1 - y0), 0);
        stbtt_MakeCodepointBitmapSubpixel(&font(), bitmap.data(), x1 - x0, y1 - y0, x1 - x0, scale,
                                          scale, shift_x, shift_y, code);
        for (int row = y0; row < y1; ++row)
            for (int column = x0; column < x1; ++column)
                blend(
                    static_cast<std::int64_t>(left) + column,
                    static_cast<std::int64_t>(baseline) + row, colour,
                    bitmap[static_cast<std::size_t>((row - y0) * (x1 - x0) + column - x0)] / 255.0);
    });
}

double Canvas::text_width(const std::string& text, double size) {
    return lay_out(text, size, [](int, double) {});
}

}  // namespace exitance
