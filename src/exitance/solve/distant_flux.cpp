// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/distant_flux.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "exitance/math/frame.h"
#include "exitance/math/polygon.h"
#include "exitance/math/warp.h"
#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
#include "exitance/visibility/beyond_glass.h"

namespace exitance {

namespace {

constexpr std::size_t ray_count = std::size_t{1} << 19;
constexpr std::size_t width = RayPacket::width;

/// A triangle of a face.
struct Piece {
    Vec3 corner, u, v, normal;
};

struct Pieces {
    std::vector<Piece> list;
    std::vector<double> cumulative;  ///< of the areas

    explicit Pieces(const Radiosity& radiosity) {
        const Mesh& mesh = radiosity.mesh;
        double total = 0;
        for (const Face& face : mesh.faces()) {
            if (radiosity.black_lamp()[face.polygon.value]) continue;
            const auto c = mesh.corners(face);
            for (std::uint32_t k = 2; k < face.count; ++k) {
                const Vec3 u = c[k - 1] - c[0], v = c[k] - c[0];
                total += 0.5 * length(cross(u, v));
                list.push_back({c[0], u, v, Vec3(face.normal)});
                cumulative.push_back(total);
            }
        }
    }
};

/// Towards the light from a place that faces `normal`, and what it brings there in the open divided
/// by the density of the directions.
struct Way {
    Vec3 direction;
    double light = 0;
};

Way way_to(const DistantLight& light, const Vec3& normal, const UnitSquare& u) {
    if (light.kind == DistantLight::Kind::disc) {
        const Frame frame(light.direction);
        const double across = std::tan(light.diameter / 2) * std::sqrt(u[0]);
        const double angle = 2 * std::numbers::pi * u[1];
        const Vec3 d = normalized(light.direction + frame.tangent * (across * std::cos(angle)) +
                                  frame.bitangent * (across * std::sin(angle)));
        return {d, light.irradiance * luminance(light.colour) * std::max(0.0, dot(d, normal))};
    }
    const Vec3 d = Frame(normal).to_world(cosine_hemisphere(u));
    return {d, luminance(light.radiance(d)) * std::numbers::pi};
}

}  // namespace

double received_flux(const Radiosity& radiosity, std::size_t which, std::uint64_t seed) {
    const DistantLight& light = radiosity.scene.distant[which];
    const Pieces pieces(radiosity);
    if (pieces.list.empty()) return 0;
    const double area = pieces.cumulative.back(), each = area / double(ray_count);
    const std::uint64_t key = hash_bits(seed, which, 0xf1u);
    const RayCaster& caster = radiosity.caster;
    return parallel_sum<double>(ray_count / width, [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t packet = begin; packet < end; ++packet) {
            RayPacket rays{};
            rays.near.fill(0.0f), rays.far.fill(std::numeric_limits<float>::infinity());
            rays.direction_y.fill(1);
            std::array<double, width> brought{};
            for (std::size_t k = 0; k < width; ++k) {
                // Systematic sampling of the places; a sequence for the directions.
                const auto i = static_cast<std::uint32_t>(packet * width + k);
                const double at = (i + uniform(key, 0)) * each;
                const auto found = static_cast<std::size_t>(
                    std::upper_bound(pieces.cumulative.begin(), pieces.cumulative.end(), at) -
                    pieces.cumulative.begin());
                const Piece& piece = pieces.list[std::min(found, pieces.list.size() - 1)];
                const std::uint64_t own = hash_bits(key, 1, i);
                const auto w = uniform_triangle({uniform(own, 0), uniform(own, 1)});
                const Vec3 place = piece.corner + piece.u * w[1] + piece.v * w[2];
                const Way way = way_to(light, piece.normal, low_discrepancy(hash_bits(key, 2), i));
                if (!(way.light > 0)) continue;
                brought[k] = way.light;
                rays.aim(k, place + piece.normal * caster.clearance() - caster.middle(),
                         way.direction);
            }
            if (rays.active == 0) continue;
            RayCaster::PacketHits hits;
            closest_beyond_glass(caster, rays, hits, [&](auto k, const auto& met) {
                // The light comes from behind the side that the ray meets.
                const bool front = met.front >> k & 1u;
                const bool taken = !front || radiosity.two_sided()[met.primitive[k]];
                brought[k] *= taken ? 0.0 : double(caster.transmittance(met.primitive[k]));
            });
            for (std::size_t k = 0; k < width; ++k)
                if ((rays.active >> k & 1u) && hits.primitive[k] == 0xffffffffu)
                    sum += brought[k] * each;
        }
        return sum;
    });
}

}  // namespace exitance
