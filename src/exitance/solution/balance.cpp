// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/balance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "exitance/math/frame.h"
#include "exitance/math/polygon.h"
#include "exitance/math/warp.h"
#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
#include "exitance/solution/lost_light.h"
#include "exitance/solution/luminaire_losses.h"

namespace exitance {

namespace {

// Rays share the flux evenly; a share of q of them that leaves has a standard error of
// sqrt(q (1-q) / n) at most, 0.14 % of the flux here when half of it leaves, and a tenth of that as
// they are stratified in space and direction.
constexpr std::size_t ray_count = std::size_t{1} << 17;

struct Sender {
    std::array<Vec3, 4> corners;
    std::uint32_t count;
    Vec3 normal;
    bool covered;  ///< partly: what its covered part seems to send never was
};

// A number for i that keeps blocks of powers of two together (Burley 2020): two sequences, one of
// them in this order, are independent and stratified each.
std::uint32_t shuffled(std::uint32_t i, std::uint64_t seed) {
    return owen_scramble(i, static_cast<std::uint32_t>(hash_bits(seed, 3)));
}

// Rays in proportion to what each sender sends, followed to where they land.
LostLight losses_of(const Radiosity& radiosity, const std::vector<Sender>& senders,
                    const std::vector<double>& cumulative, std::uint64_t seed) {
    const double total = cumulative.back(), each = total / static_cast<double>(ray_count);
    return parallel_sum<LostLight>(ray_count / RayPacket::width, [&](std::size_t begin,
                                                                     std::size_t end) {
        LostLight lost;
        for (std::size_t packet = begin; packet < end; ++packet) {
            RayPacket rays;
            rays.near.fill(0.0f), rays.far.fill(std::numeric_limits<float>::infinity());
            std::uint32_t covered = 0;
            for (std::size_t k = 0; k < RayPacket::width; ++k) {
                // Systematic sampling of the sender; sequences for place and direction.
                const auto i = static_cast<std::uint32_t>(packet * RayPacket::width + k);
                const double at = (i + uniform(seed, 0)) * each;
                const auto s = static_cast<std::size_t>(
                    std::upper_bound(cumulative.begin(), cumulative.end(), at) -
                    cumulative.begin());
                const Sender& sender = senders[std::min(s, senders.size() - 1)];
                covered |= (sender.covered ? 1u : 0u) << k;
                const Vec3 origin =
                    uniform_polygon({sender.corners.data(), sender.count},
                                    low_discrepancy(hash_bits(seed, 2), shuffled(i, seed))) +
                    sender.normal * radiosity.caster.clearance() - radiosity.caster.middle();
                const Vec3 d =
                    Frame(sender.normal).to_world(cosine_hemisphere(low_discrepancy(seed + 1, i)));
                rays.aim(k, origin, d);
            }
            std::array<double, RayPacket::width> flux;
            flux.fill(each);
            follow(radiosity, rays, flux, covered, lost);
        }
        return lost;
    });
}

}  // namespace

EnergyBalance balance(const Radiosity& radiosity, std::uint64_t seed) {
    const Mesh& mesh = radiosity.mesh;
    const Columns& columns = radiosity.columns;
    EnergyBalance out;
    out.emitted = radiosity.emitted_flux();
    if (!radiosity.emission_shot) {
        out.unshot = out.emitted;
        return out;
    }
    std::vector<Sender> senders;
    std::vector<double> cumulative;
    double sent = 0;
    std::vector<float> reflected(columns.stride), absorbed(columns.stride);
    for (const Patch& patch : mesh.patches()) {
        const Face& face = mesh[patch.face];
        const auto E = radiosity.emitted(face);
        const float tau = radiosity.caster.transmittance(face.polygon.value);
        mesh.for_leaves(patch.root, [&](ElementId id) {
            const Element& element = mesh[id];
            const auto rho = radiosity.rho(id);
            radiosity.mean_irradiance(id, absorbed);
            for (std::size_t c = 0; c < columns.stride; ++c) {
                reflected[c] = rho[c] * absorbed[c] - radiosity.shot[id][c];
                absorbed[c] *= 1.0f - rho[c] - tau;
            }
            const auto area = static_cast<double>(element.area);
            const auto open = static_cast<double>(radiosity.open_share(element));
            if (!radiosity.black_lamp()[face.polygon.value])
                out.absorbed += area * open * static_cast<double>(columns.luminance(absorbed));
            out.unshot += area * open * static_cast<double>(columns.luminance(reflected));
            const auto send = [&](std::span<const float> exitance, bool covered) {
                const double flux = area * static_cast<double>(columns.luminance(exitance));
                if (flux <= 0) return;
                sent += flux;
                senders.push_back({mesh.corners(element), element.count, face.normal, covered});
                cumulative.push_back(sent);
            };
            send(E, false);
            send(radiosity.shot[id], open < 1.0);
        });
    }
    const LostLight losses = luminaire_losses(radiosity, hash_bits(seed, 0x1a55u));
    out.escaped = losses.escaped;
    out.absorbed_behind = losses.behind;
    if (senders.empty()) return out;
    const LostLight lost = losses_of(radiosity, senders, cumulative, hash_bits(seed, 0xba1u));
    out.escaped += lost.escaped;
    out.absorbed_behind += lost.behind;
    return out;
}

}  // namespace exitance
