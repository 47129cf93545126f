// SPDX-License-Identifier: Apache-2.0
// E(x) = Σ_emitters E_j F_xj V_xj + Σ_luminaires E_l V_l + ∫ (B − E) cosθ/π dω, the last by rays
// over the hemisphere and, where little of the surface reflects much of the light, by rays towards
// that; both are combined by the balance heuristic (Veach & Guibas 1995).
#include "exitance/solution/gather.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "exitance/formfactor/point_polygon.h"
#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
#include "exitance/solution/bright_triangles.h"
#include "exitance/transport/distant_column.h"
#include "exitance/transport/luminaire_column.h"
#include "exitance/visibility/beyond_glass.h"
#include "exitance/visibility/hemisphere_rays.h"
#include "exitance/visibility/visible_fraction.h"

namespace exitance {

namespace {

/// Points of one parallel task; their visible fractions are found together.
constexpr std::size_t block_size = 64;
static_assert(block_size <= ReceiverBlock::capacity);

/// `p` moved off the surfaces it touches, to the side that they face: where a grid reaches into
/// the edge between floor and wall, the wall is in front of the point, not around it.
Vec3 clear_of_surfaces(const Surfaces& surfaces, const GatherPoint& p) {
    const double clearance = surfaces.caster().clearance();
    Vec3 offset = p.normal * clearance;
    surfaces.caster().visit_near(p.position, clearance, [&](std::uint32_t triangle, double radius) {
        const auto [a, b, c] = surfaces.corners(triangle);
        const Vec3 n = normalized(cross(b - a, c - a));
        // What faces against the point covers it rather than bounding it.
        if (dot(n, p.normal) < -0.5 || std::abs(dot(n, p.position - a)) > clearance) return radius;
        const double lacking = clearance - dot(n, offset);
        if (lacking > 0) offset += n * lacking;
        return radius;
    });
    return p.position + offset;
}

class Gatherer {
  public:
    Gatherer(const Surfaces& surfaces, std::span<const GatherPoint> points,
             std::span<double> columns, const GatherOptions& options)
        : surfaces_(surfaces),
          s_(surfaces.solution()),
          points_(points),
          out_(columns),
          options_(options),
          bright_(surfaces) {
        for (const SolutionLuminaire& placed : s_.luminaires)
            luminaires_.emplace_back(placed.luminaire);
        for (std::uint32_t l = 0; l < s_.distant.size(); ++l)
            if (s_.distant[l].light.kind == DistantLight::Kind::sky)
                skies_.emplace_back(l, s_.distant[l].light);
    }

    void block(std::size_t begin, std::size_t end) const {
        std::fill(out_.begin() + std::ptrdiff_t(begin * s_.columns()),
                  out_.begin() + std::ptrdiff_t(end * s_.columns()), 0.0);
        add_emission(begin, end);
        for (std::size_t i = begin; i < end; ++i) {
            add_reflection(i);
            if (!bright_.empty()) add_bright(i);
        }
    }

  private:
    const Surfaces& surfaces_;
    const Solution& s_;
    std::span<const GatherPoint> points_;
    std::span<double> out_;
    const GatherOptions& options_;
    const BrightTriangles bright_;
    std::vector<LuminaireSource> luminaires_;
    std::vector<std::pair<std::uint32_t, SkySource>> skies_;

    std::span<double> row(std::size_t point) const {
        return out_.subspan(point * s_.columns(), s_.columns());
    }

    void add_emission(std::size_t begin, std::size_t end) const {
        const std::size_t n = end - begin;
        const Vec3 middle = surfaces_.caster().middle();
        Receivers receivers;
        const double clearance = surfaces_.caster().clearance();  // is added again along normals
        for (std::size_t i = begin; i < end; ++i)
            receivers.add(
                clear_of_surfaces(surfaces_, points_[i]) - points_[i].normal * clearance - middle,
                points_[i].normal, static_cast<std::uint32_t>(hash_bits(options_.seed, i)));
        std::vector<std::uint32_t> order(n);
        std::iota(order.begin(), order.end(), 0u);
        add_luminaires(begin, receivers, order);
        add_suns(begin, receivers, order);
        for (const auto& [index, sky] : skies_) add_sky(begin, index, sky, receivers, order);
        ReceiverBlock block;
        block.load(receivers, order.data(), n);

        std::vector<double> factor(n);
        for (std::uint32_t e = 0; e < s_.emitters.size(); ++e) {
            const Emitter& emitter = s_.emitters[e];
            const std::span<const Vec3> corners(emitter.corners.data(), emitter.corner_count);
            bool reached = false;
            for (std::size_t i = 0; i < n; ++i) {
                const GatherPoint& p = points_[begin + i];
                factor[i] = point_polygon_factor(p.position, p.normal, corners);
                // An emitter in the point's own plane does not reach it, whatever rounding says.
                const Vec3 lifted = p.position + p.normal * clearance;
                if (factor[i] > 0 && !(point_polygon_factor(lifted, p.normal, corners) > 0))
                    factor[i] = 0;
                reached = reached || factor[i] > 0;
            }
            if (!reached) continue;
            const std::vector<double> visible = visible_shares(block, factor, e);
            const SolutionPart& part = s_.parts[emitter.part];
            const Spectrum& E =
                emitter.exitance.empty() ? s_.materials[part.material].exitance : emitter.exitance;
            for (std::size_t i = 0; i < n; ++i) {
                const std::span<double> columns = row(begin + i);
                for (std::size_t b = 0; b < E.size(); ++b)
                    columns[part.group * E.size() + b] += E[b] * factor[i] * visible[i];
            }
        }
    }

    void add_luminaires(std::size_t begin, const Receivers& receivers,
                        std::span<const std::uint32_t> which) const {
        const std::size_t bands = s_.bands.size();
        for (std::size_t l = 0; l < luminaires_.size(); ++l) {
            const std::vector<double> light =
                received_light(luminaires_[l], static_cast<std::uint32_t>(l), receivers, which);
            const SolutionLuminaire& placed = s_.luminaires[l];
            for (std::size_t i = 0; i < which.size(); ++i)
                for (std::size_t b = 0; b < bands; ++b)
                    row(begin + i)[placed.group * bands + b] +=
                        light[i] * placed.luminaire.colour[b];
        }
    }

    void add_suns(std::size_t begin, const Receivers& receivers,
                  std::span<const std::uint32_t> which) const {
        const std::size_t bands = s_.bands.size();
        for (std::size_t l = 0; l < s_.distant.size(); ++l) {
            const auto& [sun, group] = s_.distant[l];
            if (sun.kind != DistantLight::Kind::disc) continue;
            const auto number = static_cast<std::uint32_t>(hash_bits(0x5c1ULL, l));
            const std::vector<double> light = in_rounds(
                which, [&](const ColumnOptions& options, std::span<const std::uint32_t> open,
                           std::span<ColumnEntry> entries) {
                    compute_sun_column(surfaces_.caster(), sun, all_rays, number, receivers, open,
                                       options, entries);
                });
            for (std::size_t i = 0; i < which.size(); ++i)
                for (std::size_t b = 0; b < bands; ++b)
                    row(begin + i)[group * bands + b] += light[i] * sun.colour[b];
        }
    }

    /// One round in proportion to the open sky says how much of it comes in; the next is as fine as
    /// that wants it.
    void add_sky(std::size_t begin, std::uint32_t index, const SkySource& sky,
                 const Receivers& receivers, std::span<const std::uint32_t> which) const {
        const std::size_t bands = s_.bands.size();
        const std::uint32_t group = s_.distant[index].group;
        std::vector<float> light(bands);
        for (std::size_t i = 0; i < which.size(); ++i) {
            const double open = sky.irradiance(points_[begin + i].normal);
            if (!(open > 0)) continue;
            SkyEntry entry;
            double finest = open / 4096;
            for (const std::uint64_t round : {0, 1}) {
                ColumnOptions options;
                options.seed = hash_bits(options_.seed, index, round);
                compute_sky_column(surfaces_.caster(), sky, finest, index, receivers,
                                   which.subspan(i, 1), options, {&entry, 1}, light);
                finest = std::max(double(entry.received), 1e-3 * open) / options_.emitter_rays;
            }
            for (std::size_t b = 0; b < bands; ++b)
                row(begin + i)[group * bands + b] += double(light[b]);
        }
    }

    /// A tolerance that asks for all rays of a round wherever there is a penumbra.
    static constexpr double all_rays = 1e-30;

    /// Light from luminaire `l` for a colour of 1.
    std::vector<double> received_light(const LuminaireSource& source, std::uint32_t l,
                                       const Receivers& receivers,
                                       std::span<const std::uint32_t> which) const {
        const auto number = static_cast<std::uint32_t>(hash_bits(0x1abULL, l));
        return in_rounds(which,
                         [&](const ColumnOptions& options, std::span<const std::uint32_t> open,
                             std::span<ColumnEntry> entries) {
                             compute_luminaire_column(surfaces_.caster(), source, all_rays, number,
                                                      receivers, open, options, entries);
                         });
    }

    /// Light of `column`: all receivers once, and rounds with fresh patterns for those that see its
    /// source partly.
    template <class Column>
    std::vector<double> in_rounds(std::span<const std::uint32_t> which,
                                  const Column& column) const {
        constexpr std::uint32_t rays_of_round = 256;
        ColumnOptions options;
        std::vector<ColumnEntry> entries(which.size());
        std::vector<double> sum(which.size(), 0.0);
        std::vector<std::uint32_t> open(which.begin(), which.end()), partly;
        const std::uint32_t rounds =
            std::max(1u, (options_.emitter_rays + rays_of_round - 1) / rays_of_round);
        for (std::uint32_t round = 0; round < rounds && !open.empty(); ++round) {
            options.seed = hash_bits(options_.seed, round);
            entries.resize(open.size());
            column(options, open, entries);
            partly.clear();
            for (std::size_t i = 0; i < open.size(); ++i) {
                const bool whole = round == 0 && entries[i].deviation == 0;
                sum[open[i]] += double(entries[i].received()) * (whole ? rounds : 1);
                if (!whole) partly.push_back(open[i]);
            }
            open = partly;
        }
        for (double& value : sum) value /= rounds;
        return sum;
    }

    /// Visible share of the factor to emitter `e`: a probe of each point that it reaches, then
    /// rounds of 256 rays with fresh patterns for those that see it partly.
    std::vector<double> visible_shares(const ReceiverBlock& block,
                                       const std::vector<double>& factor, std::uint32_t e) const {
        constexpr std::uint16_t rays_of_round = 256;
        constexpr std::uint8_t probe_rays = 64;
        const Emitter& emitter = s_.emitters[e];
        const Source source(emitter.corners, emitter.corner_count, surfaces_.caster().middle());
        RayBudget budget{};
        for (std::size_t i = 0; i < block.size; ++i) {
            budget.probe[i] = factor[i] > 0 ? probe_rays : std::uint8_t{0};
            budget.most[i] = static_cast<std::uint16_t>(
                std::clamp<std::uint32_t>(options_.emitter_rays, probe_rays, rays_of_round));
        }
        std::vector<double> sum(block.size, 0.0), rounds(block.size, 0.0);
        VisibleFractions found;
        const std::uint32_t most_rounds =
            std::max(1u, (options_.emitter_rays + rays_of_round - 1) / rays_of_round);
        for (std::uint32_t round = 0; round < most_rounds; ++round) {
            const auto seed = static_cast<std::uint32_t>(hash_bits(options_.seed, e, round));
            find_visible_fractions(surfaces_.caster(), source, block, budget, true, seed, found);
            bool partly = false;
            for (std::size_t i = 0; i < block.size; ++i) {
                if (budget.probe[i] == 0) continue;
                const double fraction = double(found.fraction[i]);
                sum[i] += fraction;
                rounds[i] += 1;
                const bool whole = round == 0 && (fraction == 0 || fraction == 1);
                if (whole) budget.probe[i] = 0;
                partly = partly || !whole;
            }
            if (!partly) break;
        }
        for (std::size_t i = 0; i < block.size; ++i)
            if (rounds[i] > 0) sum[i] /= rounds[i];
        return sum;
    }

    void add_reflection(std::size_t point) const {
        const GatherPoint& p = points_[point];
        const Vec3f normal(p.normal);
        const Vec3f origin(clear_of_surfaces(surfaces_, p) - surfaces_.caster().middle());
        const std::uint64_t key = hash_bits(options_.seed, point, 1);
        const std::uint32_t packets = hemisphere_packets();
        if (packets == 0) return;

        RayPacket rays;
        RayCaster::PacketHits hits;
        std::vector<double> sum(s_.columns(), 0.0), H(s_.columns());
        for (std::uint32_t packet = 0; packet < packets; ++packet) {
            aim_hemisphere(rays, origin, normal, key, packet);
            std::array<double, RayPacket::width> share;
            share.fill(1);
            const auto add = [&](std::size_t i, const RayCaster::PacketHits& met) {
                if (!(met.front >> i & 1u)) return;
                const Vec3 way =
                    Vec3{rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]} *
                    double(met.distance[i]);
                const double part = share[i] * share_of_hemisphere(met.primitive[i], way, p.normal);
                add_reflected(Surfaces::place(met.primitive[i], met.u[i], met.v[i]), part, H, sum);
            };
            closest_beyond_glass(surfaces_.caster(), rays, hits, [&](auto i, const auto& met) {
                add(i, met);
                share[i] *= double(surfaces_.caster().transmittance(met.primitive[i]));
            });
            for (std::size_t i = 0; i < RayPacket::width; ++i) add(i, hits);
        }
        const std::span<double> columns = row(point);
        for (std::size_t c = 0; c < sum.size(); ++c)
            columns[c] += sum[c] / double(packets * RayPacket::width);
    }

    std::uint32_t hemisphere_packets() const {
        return (options_.hemisphere_rays + RayPacket::width - 1) / RayPacket::width;
    }
    /// Half as many rays go to what is bright.
    std::uint32_t bright_rays() const {
        return bright_.empty() ? 0 : hemisphere_packets() * RayPacket::width / 2;
    }

    /// += `part` ρ H.
    void add_reflected(const SurfacePlace& place, double part, std::span<double> H,
                       std::span<double> sum) const {
        surfaces_.irradiance(place, H);
        Surfaces::PatternHere room;
        const auto rho = surfaces_.reflectance(place, room);
        for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += part * rho[c % rho.size()] * H[c];
    }

    /// cosθ₁ cosθ₂ / (π r²) of two places, `way` from the one with normal `here` to the other.
    static double factor(const Vec3& way, const Vec3& here, const Vec3& there) {
        const double square = dot(way, way);
        const double cosines = std::max(0.0, dot(way, here)) * std::max(0.0, -dot(way, there));
        return square > 0 ? cosines / (std::numbers::pi * square * square) : 0.0;
    }

    /// What a ray over the hemisphere that met `triangle` counts beside those that looked there.
    double share_of_hemisphere(std::uint32_t triangle, const Vec3& way, const Vec3& normal) const {
        const double density = bright_.density(triangle);
        if (!(density > 0)) return 1;
        const auto [a, b, c] = surfaces_.corners(triangle);
        const double met = hemisphere_packets() * RayPacket::width *
                           factor(way, normal, normalized(cross(b - a, c - a)));
        return met > 0 ? met / (met + bright_rays() * density) : 0.0;
    }

    void add_bright(std::size_t point) const {
        const GatherPoint& p = points_[point];
        const double clearance = surfaces_.caster().clearance();
        const Vec3 middle = surfaces_.caster().middle(),
                   from = clear_of_surfaces(surfaces_, p) - middle;
        const std::uint64_t key = hash_bits(options_.seed, point, 2);
        const double over_hemisphere = hemisphere_packets() * RayPacket::width;
        std::vector<double> H(s_.columns());
        RayPacket rays;
        rays.near.fill(0.0f), rays.far.fill(1.0f);
        std::array<float, RayPacket::width> through;
        std::array<BrightTriangles::Sample, RayPacket::width> samples;
        std::array<double, RayPacket::width> part;
        for (std::uint32_t first = 0; first < bright_rays(); first += RayPacket::width) {
            rays.active = 0;
            const std::uint32_t count =
                std::min<std::uint32_t>(RayPacket::width, bright_rays() - first);
            for (std::uint32_t i = 0; i < count; ++i) {
                const auto [x, u, v, unused] = low_discrepancy_4(key, first + i);
                samples[i] = bright_.sample(x, u, v);
                const Vec3 to = samples[i].place - middle;
                const double met = factor(to - from, p.normal, samples[i].normal);
                part[i] = met / (bright_rays() * samples[i].density + over_hemisphere * met);
                if (met > 0) rays.aim(i, from, to + samples[i].normal * clearance - from);
            }
            through.fill(1.0f);
            const std::uint32_t open = rays.active & ~surfaces_.caster().occluded(rays, through);
            for (std::uint32_t i = 0; i < count; ++i)
                if (open >> i & 1u)
                    add_reflected(samples[i].at, part[i] * double(through[i]), H, row(point));
        }
    }
};

}  // namespace

void gather(const Surfaces& surfaces, std::span<const GatherPoint> points,
            std::span<double> columns, const GatherOptions& options) {
    const Gatherer gatherer(surfaces, points, columns, options);
    parallel_blocks(points.size(), block_size,
                    [&](std::size_t begin, std::size_t end) { gatherer.block(begin, end); });
}

}  // namespace exitance
