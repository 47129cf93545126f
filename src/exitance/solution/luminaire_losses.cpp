// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/luminaire_losses.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
#include "exitance/visibility/beyond_glass.h"

namespace exitance {

namespace {

// Shared among the luminaires by their flux; each has enough for 1 % of its own.
constexpr double all_rays = 1 << 20, fewest_rays = 1 << 12;

struct Lost {
    double escaped = 0, behind = 0, sent = 0;  // sums of weights
    Lost& operator+=(const Lost& o) {
        escaped += o.escaped, behind += o.behind, sent += o.sent;
        return *this;
    }
};

Lost follow(const Radiosity& radiosity, const LuminaireSource& source, std::size_t rays,
            std::uint64_t key) {
    const Luminaire& luminaire = source.luminaire();
    const DirectionSampler directions(*luminaire.photometry);
    const double clearance = radiosity.caster.clearance();
    const Vec3 middle = radiosity.caster.middle();
    return parallel_sum<Lost>(rays / RayPacket::width, [&](std::size_t begin, std::size_t end) {
        Lost lost;
        for (std::size_t packet = begin; packet < end; ++packet) {
            RayPacket p;
            std::array<double, RayPacket::width> weight;
            for (std::size_t k = 0; k < RayPacket::width; ++k) {
                const auto i = static_cast<std::uint32_t>(packet * RayPacket::width + k);
                // Systematic over the cells of the table, a sequence for the direction; with a
                // second one the place would hang together with it.
                const double cell = (i + uniform(key, 0)) / static_cast<double>(rays);
                const auto [u, v] = low_discrepancy(hash_bits(key, 1), i);
                const auto sample = directions.sample(cell, u, v);
                const Vec3 d = luminaire.to_world(sample.direction);
                const std::uint64_t own = hash_bits(key, 2, i);
                const auto from = source.sample_along(d, uniform(own, 0), uniform(own, 1));
                weight[k] = sample.weight * from.weight;
                const Vec3 origin = from.place + from.normal * clearance - middle;
                p.origin_x[k] = static_cast<float>(origin.x);
                p.origin_y[k] = static_cast<float>(origin.y);
                p.origin_z[k] = static_cast<float>(origin.z);
                p.direction_x[k] = static_cast<float>(d.x);
                p.direction_y[k] = static_cast<float>(d.y);
                p.direction_z[k] = static_cast<float>(d.z);
                p.near[k] = 0.0f;
                p.far[k] = std::numeric_limits<float>::infinity();
            }
            p.active = 0xffffu;
            RayCaster::PacketHits hits;
            for (const double w : weight) lost.sent += w;
            const auto is_black = [&](std::size_t k, const RayCaster::PacketHits& met) {
                return !(met.front >> k & 1u) && !radiosity.two_sided()[met.primitive[k]];
            };
            closest_beyond_glass(radiosity.caster, p, hits, [&](auto k, const auto& met) {
                const auto share = double(radiosity.caster.transmittance(met.primitive[k]));
                if (is_black(k, met)) lost.behind += weight[k] * (1 - share);
                weight[k] *= share;
            });
            for (std::size_t k = 0; k < RayPacket::width; ++k) {
                if (hits.primitive[k] == 0xffffffffu)
                    lost.escaped += weight[k];
                else if (is_black(k, hits))
                    lost.behind += weight[k];
            }
        }
        return lost;
    });
}

}  // namespace

LuminaireLosses luminaire_losses(const Radiosity& radiosity, std::uint64_t seed) {
    std::vector<double> flux;
    double total = 0;
    for (std::size_t l = 0; l < radiosity.luminaires.size(); ++l) {
        flux.push_back(radiosity.luminaires[l].luminaire().flux() *
                       double(radiosity.columns.luminance(radiosity.emitted_by_luminaire(l))));
        total += flux.back();
    }
    LuminaireLosses out;
    for (std::size_t l = 0; l < flux.size(); ++l) {
        if (!(flux[l] > 0)) continue;
        const double wanted = std::max(fewest_rays, std::ceil(all_rays * flux[l] / total));
        const std::size_t rays =
            static_cast<std::size_t>(wanted) / RayPacket::width * RayPacket::width;
        const Lost lost = follow(radiosity, radiosity.luminaires[l], rays, hash_bits(seed, l));
        if (!(lost.sent > 0)) continue;
        out.escaped += flux[l] * lost.escaped / lost.sent;
        out.behind += flux[l] * lost.behind / lost.sent;
    }
    return out;
}

}  // namespace exitance
