// SPDX-License-Identifier: Apache-2.0
// Pictures that vary reflectance or emission over a surface, with a pyramid of ever coarser copies
// for means over parts of them (Williams 1983).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "exitance/math/vector.h"
#include "exitance/scene/spectrum.h"

namespace exitance {

/// A place on a texture: u from the left to the right edge 0 … 1, v from the top to the bottom;
/// outside of that as the texture wraps.
struct TexturePoint {
    float u = 0, v = 0;
    friend bool operator==(const TexturePoint&, const TexturePoint&) = default;
};

/// What lies beyond an edge of the picture.
enum class TextureWrap { repeat, mirror, clamp };

/// A picture as files hold it: three bytes per texel, sRGB, rows from the top.
struct TexturePicture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

struct TextureSampling {
    TextureWrap across = TextureWrap::repeat, down = TextureWrap::repeat;
    bool nearest =
        false;  ///< texels have edges; else light goes over smoothly from one to the next
    friend bool operator==(const TextureSampling&, const TextureSampling&) = default;
};

class Texture {
  public:
    /// `picture` has at least one texel. Linear values (IEC 61966-2-1) above `most` count as it.
    Texture(TexturePicture picture, TextureSampling sampling, double most = 1);

    const TexturePicture& picture() const { return picture_; }
    const TextureSampling& sampling() const { return sampling_; }
    double most() const { return most_; }

    /// Linear RGB, 0 … 1, at a point, in full resolution.
    Vec3 at(const TexturePoint& point) const;
    /// Mean over a triangle or a convex quad of the texture; over nothing, the value there.
    Vec3 mean(std::span<const TexturePoint> corners) const;
    /// Mean over the picture.
    Vec3 mean() const;

    /// 64 bits over the texels and how they are sampled.
    std::uint64_t digest() const;

  private:
    struct Level {
        std::uint32_t width = 0, height = 0;
        std::vector<std::uint16_t> rgb;  ///< linear, in 1/65535; empty in the finest
    };
    Vec3 texel(std::size_t level, std::int64_t x, std::int64_t y) const;
    Vec3 smooth(std::size_t level, double u, double v) const;
    /// Mean over about `width` × `width` texels of the finest level around a point.
    Vec3 filtered(double u, double v, double width) const;
    Vec3 triangle_mean(const std::array<std::array<double, 2>, 3>& corners) const;

    TexturePicture picture_;
    TextureSampling sampling_;
    double most_;
    std::array<float, 256> linear_{};  ///< of a byte
    std::vector<Level> levels_;        ///< finest first, the last has one texel
};

/// A spectrum that varies over a surface: `factor` times the texture, in the bands R, G, B.
struct Pattern {
    std::shared_ptr<const Texture> texture;
    Spectrum factor{};

    explicit operator bool() const { return texture != nullptr; }
    Vec3 at(const TexturePoint& point) const { return scaled(texture->at(point)); }
    Vec3 mean(std::span<const TexturePoint> corners) const {
        return scaled(texture->mean(corners));
    }
    Vec3 mean() const { return scaled(texture->mean()); }

  private:
    Vec3 scaled(const Vec3& v) const { return {factor[0] * v.x, factor[1] * v.y, factor[2] * v.z}; }
};

}  // namespace exitance
