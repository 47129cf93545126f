// SPDX-License-Identifier: Apache-2.0
#include "exitance/render/raycast.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
#include "exitance/visibility/beyond_glass.h"

namespace exitance {

namespace {

/// Where the integral of the filter, a Gaussian of σ = 0.45 pixels cut at 1.5, reaches `u`. Along
/// each axis by itself: what is stratified stays so, and edges get all shades.
double filter_offset(double u) {
    constexpr double sigma = 0.45, radius = 1.5;
    const auto mass = [](double x) { return std::erf(x / (sigma * std::numbers::sqrt2)); };
    double low = -radius, high = radius;
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (low + high);
        (mass(middle) / mass(radius) < 2 * u - 1 ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

using SamplePattern = std::vector<std::array<double, 2>>;

/// Patterns of sample positions that neighbouring pixels draw from, many enough that none shows.
/// Their density is the filter's, so that all samples weigh the same (Ernst, Stamminger & Greiner
/// 2006).
std::vector<SamplePattern> filter_patterns(std::uint32_t samples, std::uint64_t seed) {
    std::vector<SamplePattern> patterns(64);
    for (std::size_t k = 0; k < patterns.size(); ++k)
        for (std::uint32_t s = 0; s < samples; ++s) {
            const auto [u, v] = low_discrepancy(hash_bits(seed, k), s);
            patterns[k].push_back({filter_offset(u), filter_offset(v)});
        }
    return patterns;
}

/// Fills packets with the samples of a run of pixels, one after the other.
class PacketCaster {
  public:
    PacketCaster(const Surfaces& surfaces, const CameraRays& camera,
                 const std::function<Vec3f(const ViewHit&)>& shade,
                 const std::function<Vec3f(const Vec3&)>& beyond, Raycast& out, float weight)
        : surfaces_(surfaces),
          camera_(camera),
          shade_(shade),
          beyond_(beyond),
          out_(out),
          weight_(weight) {
        const Vec3f eye(camera.eye() - surfaces.caster().middle());
        rays_.origin_x.fill(eye.x), rays_.origin_y.fill(eye.y), rays_.origin_z.fill(eye.z);
        rays_.near.fill(0.0f), rays_.far.fill(std::numeric_limits<float>::infinity());
        rays_.direction_x.fill(0.0f), rays_.direction_y.fill(0.0f), rays_.direction_z.fill(1.0f);
    }

    void add(std::size_t pixel, double x, double y) {
        const Vec3f direction(camera_.direction(x, y));
        rays_.direction_x[filled_] = direction.x;
        rays_.direction_y[filled_] = direction.y;
        rays_.direction_z[filled_] = direction.z;
        pixel_[filled_] = pixel;
        position_[filled_] = {x, y};
        if (++filled_ == RayPacket::width) cast();
    }

    void cast() {
        rays_.active = (1u << filled_) - 1;
        std::array<float, RayPacket::width> weight;
        weight.fill(weight_);
        const auto show = [&](std::size_t i, const RayCaster::PacketHits& hits) {
            const ViewHit hit{Surfaces::place(hits.primitive[i], hits.u[i], hits.v[i]),
                              position_[i][0], position_[i][1]};
            out_.image.pixels[pixel_[i]] += shade_(hit) * weight[i];
        };
        closest_beyond_glass(surfaces_.caster(), rays_, hits_, [&](auto i, const auto& hits) {
            show(i, hits);
            weight[i] *= surfaces_.caster().transmittance(hits.primitive[i]);
        });
        for (std::size_t i = 0; i < filled_; ++i) {
            if (hits_.primitive[i] == 0xffffffffu && beyond_)
                out_.image.pixels[pixel_[i]] +=
                    beyond_({double(rays_.direction_x[i]), double(rays_.direction_y[i]),
                             double(rays_.direction_z[i])}) *
                    weight[i];
            if (!(hits_.front >> i & 1u)) continue;
            show(i, hits_);
            out_.coverage[pixel_[i]] += weight_;
        }
        filled_ = 0;
    }

  private:
    const Surfaces& surfaces_;
    const CameraRays& camera_;
    const std::function<Vec3f(const ViewHit&)>& shade_;
    const std::function<Vec3f(const Vec3&)>& beyond_;
    Raycast& out_;
    float weight_;
    RayPacket rays_;
    RayCaster::PacketHits hits_;
    std::array<std::size_t, RayPacket::width> pixel_;
    std::array<std::array<double, 2>, RayPacket::width> position_;
    std::size_t filled_ = 0;
};

}  // namespace

Raycast raycast(const Surfaces& surfaces, const CameraRays& camera, std::uint32_t width,
                std::uint32_t height, std::uint32_t samples, std::uint64_t seed,
                const std::function<Vec3f(const ViewHit&)>& shade,
                const std::function<Vec3f(const Vec3&)>& beyond) {
    Raycast out{Image(width, height), std::vector<float>(std::size_t{width} * height, 0.0f)};
    const std::vector<SamplePattern> patterns = filter_patterns(samples, seed);
    constexpr std::uint32_t tile = 16;
    const std::uint32_t across = (width + tile - 1) / tile, down = (height + tile - 1) / tile;
    parallel_for(
        std::size_t{across} * down,
        [&](std::size_t t) {
            PacketCaster caster(surfaces, camera, shade, beyond, out,
                                1.0f / static_cast<float>(samples));
            const auto left = static_cast<std::uint32_t>(t % across) * tile,
                       top = static_cast<std::uint32_t>(t / across) * tile;
            for (std::uint32_t y = top; y < std::min(height, top + tile); ++y)
                for (std::uint32_t x = left; x < std::min(width, left + tile); ++x) {
                    const std::size_t pixel = std::size_t{y} * width + x;
                    for (const auto& [dx, dy] : patterns[hash_bits(pixel) % patterns.size()])
                        caster.add(pixel, x + 0.5 + dx, y + 0.5 + dy);
                }
            caster.cast();
        },
        1);
    return out;
}

}  // namespace exitance
