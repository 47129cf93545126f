// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/luminaire_losses.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
#include "exitance/solution/lost_light.h"

namespace exitance {

namespace {

// Shared among the luminaires by their flux; each has enough for 1 % of its own.
constexpr double all_rays = 1 << 20, fewest_rays = 1 << 12;

struct Followed {
    LostLight lost;
    double sent = 0;  ///< sum of the weights that the losses are in
    Followed& operator+=(const Followed& o) {
        lost += o.lost, sent += o.sent;
        return *this;
    }
};

Followed follow(const Radiosity& radiosity, const LuminaireSource& source, std::size_t rays,
                std::uint64_t key) {
    const Luminaire& luminaire = source.luminaire();
    const DirectionSampler directions(*luminaire.photometry);
    const double clearance = radiosity.caster.clearance();
    const Vec3 middle = radiosity.caster.middle();
    return parallel_sum<Followed>(rays / RayPacket::width, [&](std::size_t begin, std::size_t end) {
        Followed all;
        for (std::size_t packet = begin; packet < end; ++packet) {
            RayPacket p;
            p.near.fill(0.0f), p.far.fill(std::numeric_limits<float>::infinity());
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
                p.aim(k, origin, d);
            }
            for (const double w : weight) all.sent += w;
            follow(radiosity, p, weight, 0, all.lost);
        }
        return all;
    });
}

}  // namespace

LostLight luminaire_losses(const Radiosity& radiosity, std::uint64_t seed) {
    std::vector<double> flux;
    double total = 0;
    for (std::size_t l = 0; l < radiosity.luminaires.size(); ++l) {
        flux.push_back(radiosity.luminaires[l].luminaire().flux() *
                       double(radiosity.columns.luminance(radiosity.emitted_by_luminaire(l))));
        total += flux.back();
    }
    LostLight out;
    for (std::size_t l = 0; l < flux.size(); ++l) {
        if (!(flux[l] > 0)) continue;
        const double wanted = std::max(fewest_rays, std::ceil(all_rays * flux[l] / total));
        const std::size_t rays =
            static_cast<std::size_t>(wanted) / RayPacket::width * RayPacket::width;
        const auto [lost, sent] =
            follow(radiosity, radiosity.luminaires[l], rays, hash_bits(seed, l));
        if (!(sent > 0)) continue;
        out.escaped += flux[l] * lost.escaped / sent;
        out.behind += flux[l] * lost.behind / sent;
    }
    return out;
}

}  // namespace exitance
