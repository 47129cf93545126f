// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/texture.h"

#include <algorithm>
#include <cmath>

#include "exitance/run/random.h"

namespace exitance {

namespace {

// A triangle's mean is that of 64 equal parts, each looked up once in the pyramid at its own size.
constexpr std::uint32_t parts_per_side = 8;

double linear_of_srgb(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

std::int64_t wrapped(std::int64_t i, std::int64_t size, TextureWrap wrap) {
    if (wrap == TextureWrap::clamp) return std::clamp<std::int64_t>(i, 0, size - 1);
    const std::int64_t period = wrap == TextureWrap::mirror ? 2 * size : size;
    const std::int64_t at = (i % period + period) % period;
    return at < size ? at : period - 1 - at;
}

// Far outside, float coordinates tell no texels apart; this keeps them within integers.
double tamed(double coordinate) {
    return std::isfinite(coordinate) ? std::clamp(coordinate, -1e6, 1e6) : 0.0;
}

/// Which texels of a row of `from` a texel of the next coarser row of `to` covers, and how much of
/// it each: their weights sum to 1, so that means stay what they are.
struct Cover {
    std::uint32_t first = 0;
    std::vector<double> share;
};

std::vector<Cover> covers(std::uint32_t from, std::uint32_t to) {
    std::vector<Cover> out(to);
    const double width = double(from) / double(to);
    for (std::uint32_t i = 0; i < to; ++i) {
        const double begin = i * width, end = begin + width;
        out[i].first = static_cast<std::uint32_t>(begin);
        for (std::uint32_t k = out[i].first; k < from && k < end - 1e-9; ++k)
            out[i].share.push_back((std::min(end, k + 1.0) - std::max(begin, double(k))) / width);
    }
    return out;
}

}  // namespace

Texture::Texture(TexturePicture picture, TextureSampling sampling, double most)
    : picture_(std::move(picture)), sampling_(sampling), most_(most) {
    for (std::size_t i = 0; i < linear_.size(); ++i)
        linear_[i] = static_cast<float>(std::min(most, linear_of_srgb(double(i) / 255)));
    levels_.push_back({picture_.width, picture_.height, {}});
    while (levels_.back().width > 1 || levels_.back().height > 1) {
        const std::size_t fine = levels_.size() - 1;
        Level next{
            std::max(1u, levels_[fine].width / 2), std::max(1u, levels_[fine].height / 2), {}};
        next.rgb.reserve(std::size_t{3} * next.width * next.height);
        const auto across = covers(levels_[fine].width, next.width);
        const auto down = covers(levels_[fine].height, next.height);
        for (const Cover& row : down)
            for (const Cover& column : across) {
                Vec3 sum;
                for (std::size_t j = 0; j < row.share.size(); ++j)
                    for (std::size_t i = 0; i < column.share.size(); ++i)
                        sum += texel(fine, column.first + std::int64_t(i),
                                     row.first + std::int64_t(j)) *
                               (row.share[j] * column.share[i]);
                for (std::size_t c = 0; c < 3; ++c)
                    next.rgb.push_back(static_cast<std::uint16_t>(std::lround(sum[c] * 65535)));
            }
        levels_.push_back(std::move(next));
    }
}

Vec3 Texture::texel(std::size_t level, std::int64_t x, std::int64_t y) const {
    const Level& l = levels_[level];
    const auto i = static_cast<std::size_t>(wrapped(x, l.width, sampling_.across));
    const auto j = static_cast<std::size_t>(wrapped(y, l.height, sampling_.down));
    const std::size_t at = 3 * (j * l.width + i);
    if (level == 0) {
        const auto value = [&](std::size_t c) { return double(linear_[picture_.rgb[at + c]]); };
        return {value(0), value(1), value(2)};
    }
    return Vec3{double(l.rgb[at]), double(l.rgb[at + 1]), double(l.rgb[at + 2])} * (1 / 65535.0);
}

Vec3 Texture::smooth(std::size_t level, double u, double v) const {
    const Level& l = levels_[level];
    const double x = tamed(u) * l.width - 0.5, y = tamed(v) * l.height - 0.5;
    const double left = std::floor(x), top = std::floor(y);
    const double s = x - left, t = y - top;
    const auto i = static_cast<std::int64_t>(left), j = static_cast<std::int64_t>(top);
    return (texel(level, i, j) * (1 - s) + texel(level, i + 1, j) * s) * (1 - t) +
           (texel(level, i, j + 1) * (1 - s) + texel(level, i + 1, j + 1) * s) * t;
}

Vec3 Texture::at(const TexturePoint& point) const {
    const double u = double(point.u), v = double(point.v);
    if (!sampling_.nearest) return smooth(0, u, v);
    return texel(0, static_cast<std::int64_t>(std::floor(tamed(u) * picture_.width)),
                 static_cast<std::int64_t>(std::floor(tamed(v) * picture_.height)));
}

Vec3 Texture::filtered(double u, double v, double width) const {
    if (!(width > 1)) return at({static_cast<float>(u), static_cast<float>(v)});
    const double level = std::log2(width);
    const auto fine = static_cast<std::size_t>(level);
    if (fine + 1 >= levels_.size()) return texel(levels_.size() - 1, 0, 0);
    const double share = level - double(fine);
    return smooth(fine, u, v) * (1 - share) + smooth(fine + 1, u, v) * share;
}

Vec3 Texture::triangle_mean(const std::array<std::array<double, 2>, 3>& c) const {
    const double a = c[1][0] - c[0][0], b = c[1][1] - c[0][1];
    const double d = c[2][0] - c[0][0], e = c[2][1] - c[0][1];
    // Side of a square as large as one part [texels of the finest level].
    const double part =
        std::sqrt(0.5 * std::abs(a * e - b * d) * picture_.width * picture_.height) /
        parts_per_side;
    Vec3 sum;
    for (std::uint32_t j = 0; j < parts_per_side; ++j)
        for (std::uint32_t i = 0; i + j < parts_per_side; ++i)
            for (const double third : {1.0 / 3, 2.0 / 3}) {
                if (third > 0.5 && i + j + 1 == parts_per_side) continue;
                const double s = (i + third) / parts_per_side, t = (j + third) / parts_per_side;
                sum += filtered(c[0][0] + a * s + d * t, c[0][1] + b * s + e * t, part);
            }
    return sum * (1.0 / (parts_per_side * parts_per_side));
}

Vec3 Texture::mean(std::span<const TexturePoint> corners) const {
    const auto at = [&](std::size_t i) {
        return std::array<double, 2>{tamed(double(corners[i].u)), tamed(double(corners[i].v))};
    };
    const auto doubled = [&](std::size_t i, std::size_t j, std::size_t k) {
        const auto a = at(i), b = at(j), c = at(k);
        return std::abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    };
    if (corners.size() < 4) return triangle_mean({at(0), at(1), at(2)});
    const double first = doubled(0, 1, 2), second = doubled(0, 2, 3);
    const double share = first + second > 0 ? first / (first + second) : 0.5;
    return triangle_mean({at(0), at(1), at(2)}) * share +
           triangle_mean({at(0), at(2), at(3)}) * (1 - share);
}

Vec3 Texture::mean() const {
    return texel(levels_.size() - 1, 0, 0);
}

std::uint64_t Texture::digest() const {
    std::uint64_t h = hash_bits(picture_.width, picture_.height);
    h = hash_bits(h, static_cast<std::uint64_t>(sampling_.across),
                  static_cast<std::uint64_t>(sampling_.down));
    h = hash_bits(h, sampling_.nearest);
    for (const std::uint8_t byte : picture_.rgb) h = hash_bits(h, byte);
    return h;
}

}  // namespace exitance
