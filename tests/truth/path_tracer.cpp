// SPDX-License-Identifier: Apache-2.0
#include "truth/path_tracer.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <numbers>

#include "exitance/math/frame.h"
#include "exitance/math/polygon.h"
#include "exitance/math/warp.h"
#include "exitance/run/parallel.h"
#include "exitance/run/random.h"

namespace exitance::truth {

namespace {

constexpr std::size_t width = RayPacket::width;
// Weights below this are raised to it or ended. Cornell box, same paths: 0.4 gives 15 % more noise
// for 15 % fewer rays, 0.03 no less noise for 30 % more.
constexpr double roulette_below = 0.1;
constexpr std::uint32_t stratified_bounces = 2;

RayCaster make_caster(const Scene& scene) {
    std::vector<RayCaster::Face> faces;
    std::vector<float> transmittance;
    for (const Polygon& polygon : scene.polygons) {
        const auto& c = polygon.corners;
        faces.push_back({c[0], c[1], c[2], polygon.size() == 4 ? c[3] : c[2]});
        transmittance.push_back(static_cast<float>(scene.material(polygon).clear_transmittance()));
    }
    return RayCaster(scene.points, faces, {}, std::move(transmittance));
}

std::vector<std::array<std::uint32_t, 2>> sobol_table(std::uint32_t count) {
    std::vector<std::array<std::uint32_t, 2>> table(count);
    for (std::uint32_t i = 0; i < count; ++i) table[i] = sobol(i);
    return table;
}

std::vector<Receiver> receivers_of(const SensorGrid& grid, bool texels) {
    std::vector<Receiver> receivers;
    const Vec3 du = grid.u / grid.columns, dv = grid.v / grid.rows;
    for (std::uint32_t j = 0; j < grid.rows; ++j)
        for (std::uint32_t i = 0; i < grid.columns; ++i)
            receivers.push_back({grid.origin + du * (i + 0.5) + dv * (j + 0.5),
                                 normalized(grid.normal), texels ? du : Vec3{},
                                 texels ? dv : Vec3{}});
    return receivers;
}

}  // namespace

std::vector<Receiver> centres_of(const SensorGrid& grid) {
    return receivers_of(grid, false);
}
std::vector<Receiver> texels_of(const SensorGrid& grid) {
    return receivers_of(grid, true);
}

double Estimate::rms_error(std::size_t column) const {
    double sum = 0;
    const std::size_t rows = standard_error.size() / columns;
    for (std::size_t p = 0; p < rows; ++p) sum += error_at(p, column) * error_at(p, column);
    return std::sqrt(sum / static_cast<double>(rows));
}

double Estimate::average(std::size_t column) const {
    double sum = 0;
    const std::size_t rows = mean.size() / columns;
    for (std::size_t p = 0; p < rows; ++p) sum += at(p, column);
    return sum / static_cast<double>(rows);
}

/// Sixteen paths that began at one receiver, and the vertex each has reached.
struct PathTracer::Walk {
    std::uint64_t key = 0;     ///< of the receiver and replicate
    std::uint32_t first = 0;   ///< sample index of lane 0
    std::uint32_t bounce = 0;  ///< 0 at the receiver itself
    std::uint32_t active = 0;  ///< bit mask of the paths that go on
    std::size_t bands = 0;
    std::span<const std::array<std::uint32_t, 2>> sobol;
    std::array<Vec3, width> position, normal;  ///< clear of the surface
    std::vector<double> weight;                ///< lane × band: product of reflectances / chances
    std::uint64_t rays = 0;

    std::span<double> weight_of(std::size_t lane) { return {&weight[lane * bands], bands}; }

    enum Purpose : std::uint32_t { texel, light, direction, survival, lamp = 1u << 20 };

    /// Two numbers in [0, 1) for `purpose` at this bounce: for the first bounces a point of an
    /// Owen-scrambled Sobol' set, shuffled so that the pairs of one path are independent (Burley
    /// 2020, section 3); later plain random numbers, where strata are long lost.
    UnitSquare numbers(Purpose purpose, std::size_t lane) const {
        const std::uint64_t stream = hash_bits(key, std::uint64_t{bounce} * 4 + purpose);
        const std::uint32_t index = first + static_cast<std::uint32_t>(lane);
        if (bounce >= stratified_bounces)
            return {uniform(stream, 2 * index), uniform(stream, 2 * index + 1)};
        const std::uint64_t scramble = hash_bits(stream);
        const auto mask = static_cast<std::uint32_t>(sobol.size() - 1);
        const auto [x, y] = sobol[owen_scramble(index, static_cast<std::uint32_t>(stream)) & mask];
        return {owen_scramble(x, static_cast<std::uint32_t>(scramble)) * 0x1.0p-32,
                owen_scramble(y, static_cast<std::uint32_t>(scramble >> 32)) * 0x1.0p-32};
    }
};

PathTracer::PathTracer(const Scene& scene, Grouping grouping)
    : bands_(scene.bands.size()),
      groups_(make_groups(scene, grouping)),
      materials_(scene.materials),
      caster_(make_caster(scene)) {
    double flux = 0;
    for (const Polygon& polygon : scene.polygons) {
        const Material& material = scene.material(polygon);
        Face face{scene.normal(polygon), scene.surfaces[polygon.surface].material,
                  groups_.group_of_surface[polygon.surface], 0};
        if (material.emits()) {
            double exitance = 0;
            for (const double e : material.exitance) exitance += e;
            face.density = exitance;
            // Embree's diagonal, so that the emitter is the surface that rays hit.
            const auto c = scene.corners(polygon);
            std::vector<std::array<Vec3, 3>> triangles{{c[0], c[1], c[2]}};
            if (polygon.size() == 4) triangles = {{c[0], c[1], c[3]}, {c[2], c[3], c[1]}};
            for (const auto& t : triangles) {
                flux += exitance * area(t);
                emitters_.push_back({t[0], t[1] - t[0], t[2] - t[0],
                                     static_cast<std::uint32_t>(faces_.size()), flux});
            }
        }
        faces_.push_back(face);
    }
    for (Emitter& emitter : emitters_) emitter.cumulative /= flux;
    for (Face& face : faces_)
        if (face.density > 0) face.density /= flux;
    add_lamps(scene);
    distant_ = scene.distant;
    for (const Material& material : materials_)
        glass_ = glass_ || material.clear_transmittance() > 0;
}

/// What the glass between two places lets through, if nothing else is there.
double PathTracer::through(const Vec3& from, const Vec3& way, double far) const {
    double share = 1, near = 0;
    for (int pane = 0; pane < 64; ++pane) {
        const auto hit = caster_.closest(from, way, near, far);
        if (!hit) return share;
        const double passes = materials_[faces_[hit->primitive].material].clear_transmittance();
        if (!(passes > 0)) return 0;
        share *= passes;
        near = double(hit->distance) + caster_.clearance() / length(way);
    }
    return 0;
}

/// One direction within every sun per path.
void PathTracer::sample_suns(Walk& walk, std::span<double> sums) const {
    for (std::size_t l = 0; l < distant_.size(); ++l) {
        const DistantLight& sun = distant_[l];
        if (sun.kind != DistantLight::Kind::disc) continue;
        const Frame frame(sun.direction);
        for (std::size_t lane = 0; lane < width; ++lane) {
            if (!(walk.active >> lane & 1u)) continue;
            const UnitSquare u = walk.numbers(Walk::lamp, lane);
            const double r = std::tan(sun.diameter / 2) * std::sqrt(u[0]);
            const Vec3 d =
                normalized(frame.to_world({r * std::cos(2 * std::numbers::pi * u[1]),
                                           r * std::sin(2 * std::numbers::pi * u[1]), 1}));
            const double facing = dot(d, walk.normal[lane]);
            if (!(facing > 0)) continue;
            ++walk.rays;
            const double share =
                through(walk.position[lane], d, std::numeric_limits<double>::infinity());
            for (std::size_t b = 0; b < bands_ && share > 0; ++b)
                sums[groups_.group_of_distant[l] * bands_ + b] +=
                    walk.weight_of(lane)[b] * sun.irradiance * facing * share * sun.colour[b];
        }
    }
}

void PathTracer::add_lamps(const Scene& scene) {
    double flux = 0;
    for (std::size_t l = 0; l < scene.luminaires.size(); ++l) {
        Lamp lamp;
        lamp.luminaire = scene.luminaires[l];
        lamp.group = groups_.group_of_luminaire[l];
        lamp.cumulative = flux += lamp.luminaire.flux();
        double area = 0;
        for (const OpeningFacet& facet : facets(lamp.luminaire.photometry->opening)) {
            std::array<Vec3, 4> c;
            for (std::size_t i = 0; i < 4; ++i)
                c[i] = lamp.luminaire.position + lamp.luminaire.to_world(facet.corners[i]);
            const Vec3 n = lamp.luminaire.to_world(facet.normal);
            for (std::uint32_t i = 2; i < facet.count; ++i) {
                const Vec3 a = c[i - 1] - c[0], b = c[i] - c[0];
                lamp.pieces.push_back({c[0], a, b, n, area += 0.5 * length(cross(a, b))});
            }
        }
        lamps_.push_back(std::move(lamp));
    }
    for (Lamp& lamp : lamps_) lamp.cumulative /= flux;
}

/// One place of a luminaire per path. With A(ω) = Σ A (n·ω)⁺ the area that the opening shows along
/// ω, the place sends I(ω) (n·ω)⁺ / A(ω) per area.
void PathTracer::sample_lamps(Walk& walk, std::span<double> sums) const {
    if (lamps_.empty()) return;
    RayPacket rays{};
    rays.near.fill(0.0f), rays.far.fill(1.0f);
    std::array<const Lamp*, width> lamps{};
    std::array<double, width> light{};
    const Vec3 middle = caster_.middle();
    for (std::size_t lane = 0; lane < width; ++lane) {
        if (!(walk.active >> lane & 1u)) continue;
        UnitSquare u = walk.numbers(Walk::lamp, lane);
        const auto chosen =
            std::min(std::upper_bound(lamps_.begin(), lamps_.end(), u[0],
                                      [](double x, const Lamp& l) { return x < l.cumulative; }),
                     lamps_.end() - 1);
        const double below = chosen == lamps_.begin() ? 0.0 : (chosen - 1)->cumulative;
        const double chance = chosen->cumulative - below;
        u[0] = (u[0] - below) / chance;
        const Luminaire& luminaire = chosen->luminaire;
        Vec3 place = luminaire.position, normal{};
        double area = 1;
        if (!chosen->pieces.empty()) {
            area = chosen->pieces.back().cumulative;
            const auto piece = std::min(
                std::upper_bound(chosen->pieces.begin(), chosen->pieces.end(), u[0] * area,
                                 [](double x, const Lamp::Piece& p) { return x < p.cumulative; }),
                chosen->pieces.end() - 1);
            const double before = piece == chosen->pieces.begin() ? 0.0 : (piece - 1)->cumulative;
            u[0] = (u[0] * area - before) / (piece->cumulative - before);
            const auto [w0, w1, w2] = uniform_triangle(u);
            place = piece->corner + piece->edge1 * w1 + piece->edge2 * w2;
            normal = piece->normal;
        } else if (luminaire.photometry->opening.extent() > 0) {
            place += luminaire.to_world(luminaire.photometry->opening.size) * (u[0] - 0.5);
        }
        const Vec3 way = walk.position[lane] - place;
        const double r2 = dot(way, way), r = std::sqrt(r2);
        const Vec3 along = way / r;
        const double cos_here = -dot(along, walk.normal[lane]);
        if (cos_here <= 0) continue;
        double share = 1;
        if (!chosen->pieces.empty()) {
            double shown = 0, before = 0;
            for (const Lamp::Piece& p : chosen->pieces) {
                shown += (p.cumulative - before) * std::max(0.0, dot(p.normal, along));
                before = p.cumulative;
            }
            const double facing = dot(normal, along);
            if (facing <= 0) continue;
            share = area * facing / shown;
        } else {
            const double below_it = dot(along, luminaire.nadir);
            normal = below_it > 0 ? luminaire.nadir : -luminaire.nadir;
        }
        light[lane] = luminaire.intensity(along) * share * cos_here / (r2 * chance);
        if (!(light[lane] > 0)) continue;
        lamps[lane] = &*chosen;
        const Vec3 target = place + normal * caster_.clearance();
        const Vec3f o(walk.position[lane] - middle), d(target - walk.position[lane]);
        rays.origin_x[lane] = o.x, rays.origin_y[lane] = o.y, rays.origin_z[lane] = o.z;
        rays.direction_x[lane] = d.x, rays.direction_y[lane] = d.y, rays.direction_z[lane] = d.z;
        rays.active |= 1u << lane;
    }
    walk.rays += static_cast<std::uint64_t>(std::popcount(rays.active));
    const std::uint32_t seen = rays.active & ~caster_.occluded(rays);
    std::array<double, width> panes;
    panes.fill(1);
    for (std::size_t lane = 0; glass_ && lane < width; ++lane)
        if (seen >> lane & 1u)
            panes[lane] = through(walk.position[lane],
                                  {double(rays.direction_x[lane]), double(rays.direction_y[lane]),
                                   double(rays.direction_z[lane])},
                                  1);
    for (std::size_t lane = 0; lane < width; ++lane)
        for (std::size_t b = 0; b < bands_ && (seen >> lane & 1u); ++b)
            sums[lamps[lane]->group * bands_ + b] += walk.weight_of(lane)[b] * light[lane] *
                                                     lamps[lane]->luminaire.colour[b] * panes[lane];
}

/// Adds weight · M · k / (p + k): with k = cosθ cosθ' / π r² the density per emitter area of
/// cosine-distributed directions and p that of emitter samples, this is the contribution of a
/// sample of either kind under the balance heuristic. `facing` is k r².
void PathTracer::add_emission(const Face& face, bool front, double facing, double r2,
                              std::span<const double> weight, std::span<double> sums) const {
    const Material& material = materials_[face.material];
    if (face.density == 0 || facing <= 0 || (!front && !material.two_sided)) return;
    const double share = facing / (face.density * r2 + facing);
    for (std::size_t b = 0; b < bands_; ++b)
        sums[face.group * bands_ + b] += weight[b] * material.exitance[b] * share;
}

/// One point of an emitter per path, where it is seen from the path's vertex.
void PathTracer::sample_lights(Walk& walk, std::span<double> sums) const {
    if (emitters_.empty()) return;
    RayPacket rays{};
    std::array<const Face*, width> faces{};
    std::array<double, width> facing{}, squared{};
    std::array<bool, width> fronts{};
    const Vec3 middle = caster_.middle();
    for (std::size_t lane = 0; lane < width; ++lane) {
        if (!(walk.active >> lane & 1u)) continue;
        UnitSquare u = walk.numbers(Walk::light, lane);
        const auto chosen =
            std::min(std::upper_bound(emitters_.begin(), emitters_.end(), u[0],
                                      [](double x, const Emitter& e) { return x < e.cumulative; }),
                     emitters_.end() - 1);
        const double below = chosen == emitters_.begin() ? 0.0 : (chosen - 1)->cumulative;
        u[0] = (u[0] - below) / (chosen->cumulative - below);
        const auto [w0, w1, w2] = uniform_triangle(u);
        const Face& face = faces_[chosen->face];
        const Vec3 on_light = chosen->corner + chosen->edge1 * w1 + chosen->edge2 * w2;

        const Vec3 to = on_light - walk.position[lane];
        const double r2 = dot(to, to);
        const double cos_here = dot(to, walk.normal[lane]);
        const double cos_there = -dot(to, face.normal);
        fronts[lane] = cos_there > 0;
        if (cos_here <= 0 || cos_there == 0) continue;
        if (!fronts[lane] && !materials_[face.material].two_sided) continue;
        facing[lane] = cos_here * std::abs(cos_there) / (std::numbers::pi * r2);
        squared[lane] = r2;
        faces[lane] = &face;
        const Vec3 target =
            on_light + face.normal * (fronts[lane] ? caster_.clearance() : -caster_.clearance());
        const Vec3f o(walk.position[lane] - middle), d(target - walk.position[lane]);
        rays.origin_x[lane] = o.x, rays.origin_y[lane] = o.y, rays.origin_z[lane] = o.z;
        rays.direction_x[lane] = d.x, rays.direction_y[lane] = d.y, rays.direction_z[lane] = d.z;
        rays.near[lane] = 0, rays.far[lane] = 1;
        rays.active |= 1u << lane;
    }
    walk.rays += static_cast<std::uint64_t>(std::popcount(rays.active));
    const std::uint32_t seen = rays.active & ~caster_.occluded(rays);
    for (std::size_t lane = 0; lane < width; ++lane)
        if (seen >> lane & 1u) {
            // A sample of the lights stands for 1/p, one of the directions for 1/k.
            std::vector<double> weight(walk.weight_of(lane).begin(), walk.weight_of(lane).end());
            const Vec3 way(rays.direction_x[lane], rays.direction_y[lane], rays.direction_z[lane]);
            for (double& w : weight) w *= glass_ ? through(walk.position[lane], way, 1) : 1;
            add_emission(*faces[lane], fronts[lane], facing[lane], squared[lane], weight, sums);
        }
}

/// Every path to its next vertex, in a direction distributed as cosθ/π.
void PathTracer::step(Walk& walk, std::span<double> sums) const {
    RayPacket rays{};
    rays.active = walk.active;
    std::array<Vec3, width> directions;
    const Vec3 middle = caster_.middle();
    for (std::size_t lane = 0; lane < width; ++lane) {
        if (!(walk.active >> lane & 1u)) continue;
        directions[lane] = Frame(walk.normal[lane])
                               .to_world(cosine_hemisphere(walk.numbers(Walk::direction, lane)));
        const Vec3f o(walk.position[lane] - middle), d(directions[lane]);
        rays.origin_x[lane] = o.x, rays.origin_y[lane] = o.y, rays.origin_z[lane] = o.z;
        rays.direction_x[lane] = d.x, rays.direction_y[lane] = d.y, rays.direction_z[lane] = d.z;
        rays.near[lane] = 0, rays.far[lane] = std::numeric_limits<float>::infinity();
    }
    walk.rays += static_cast<std::uint64_t>(std::popcount(rays.active));
    RayCaster::PacketHits hits;
    caster_.closest(rays, hits);
    for (std::size_t lane = 0; glass_ && lane < width; ++lane) {
        double near = 0;
        while ((rays.active >> lane & 1u) && hits.primitive[lane] != 0xffffffffu) {
            const Material& pane = materials_[faces_[hits.primitive[lane]].material];
            if (!(pane.clear_transmittance() > 0)) break;
            for (double& w : walk.weight_of(lane)) w *= pane.clear_transmittance();
            near = double(hits.distance[lane]) + caster_.clearance();
            const auto next = caster_.closest(walk.position[lane], directions[lane], near,
                                              std::numeric_limits<double>::infinity());
            hits.primitive[lane] = next ? next->primitive : 0xffffffffu;
            if (!next) break;
            hits.distance[lane] = next->distance;
            const bool front = dot(Vec3(next->geometric_normal), directions[lane]) < 0;
            hits.front = (hits.front & ~(1u << lane)) | (front ? 1u << lane : 0u);
        }
    }

    ++walk.bounce;
    walk.active = 0;
    for (std::size_t lane = 0; lane < width; ++lane) {
        if (!(rays.active >> lane & 1u)) continue;
        if (hits.primitive[lane] == 0xffffffffu) {
            for (std::size_t l = 0; l < distant_.size(); ++l) {
                if (distant_[l].kind != DistantLight::Kind::sky) continue;
                const Spectrum L = distant_[l].radiance(directions[lane]);
                for (std::size_t b = 0; b < bands_; ++b)
                    sums[groups_.group_of_distant[l] * bands_ + b] +=
                        walk.weight_of(lane)[b] * std::numbers::pi * L[b];
            }
            continue;
        }
        const Face& face = faces_[hits.primitive[lane]];
        const Material& material = materials_[face.material];
        const bool front = hits.front >> lane & 1u;
        const double distance = hits.distance[lane];
        const auto weight = walk.weight_of(lane);
        const double cos_here = dot(directions[lane], walk.normal[lane]);
        const double cos_there = std::abs(dot(directions[lane], face.normal));
        add_emission(face, front, cos_here * cos_there / std::numbers::pi, distance * distance,
                     weight, sums);
        if (!front && !material.two_sided) continue;

        double strongest = 0;
        for (std::size_t b = 0; b < bands_; ++b) {
            weight[b] *= material.reflectance[b];
            strongest = std::max(strongest, weight[b]);
        }
        if (strongest <= 0) continue;
        if (strongest < roulette_below) {
            const double chance = strongest / roulette_below;
            if (walk.numbers(Walk::survival, lane)[0] >= chance) continue;
            for (double& w : weight) w /= chance;
        }
        walk.normal[lane] = front ? face.normal : -face.normal;
        walk.position[lane] += directions[lane] * distance;
        walk.position[lane] += walk.normal[lane] * caster_.clearance();
        walk.active |= 1u << lane;
    }
}

Estimate PathTracer::irradiance(std::span<const Receiver> receivers, const Effort& effort) const {
    if (!std::has_single_bit(effort.samples) || effort.samples < width || effort.replicates < 2)
        throw Error(Fault::wrong_use,
                    "samples must be a power of two of at least 16, replicates at least 2");
    const auto table = sobol_table(effort.samples);
    Estimate out;
    out.columns = columns();
    out.mean.resize(receivers.size() * out.columns);
    out.standard_error.resize(receivers.size() * out.columns);
    std::atomic<std::uint64_t> rays{0};

    parallel_for(
        receivers.size(),
        [&](std::size_t p) {
            const Receiver& receiver = receivers[p];
            std::vector<double> sum(out.columns), squares(out.columns), replicate(out.columns);
            Walk walk;
            walk.sobol = table;
            walk.bands = bands_;
            for (std::uint32_t r = 0; r < effort.replicates; ++r) {
                std::fill(replicate.begin(), replicate.end(), 0.0);
                walk.key = hash_bits(effort.seed, std::uint64_t{p}, std::uint64_t{r});
                for (walk.first = 0; walk.first < effort.samples; walk.first += width) {
                    walk.bounce = 0;
                    walk.active = 0xffffu;
                    walk.weight.assign(width * bands_, 1.0);
                    for (std::size_t lane = 0; lane < width; ++lane) {
                        const auto [s, t] = walk.numbers(Walk::texel, lane);
                        walk.normal[lane] = receiver.normal;
                        walk.position[lane] = receiver.position + receiver.u * (s - 0.5) +
                                              receiver.v * (t - 0.5) +
                                              receiver.normal * caster_.clearance();
                    }
                    while (walk.active) {
                        sample_lights(walk, replicate);
                        sample_lamps(walk, replicate);
                        sample_suns(walk, replicate);
                        step(walk, replicate);
                    }
                }
                for (std::size_t c = 0; c < out.columns; ++c) {
                    const double mean = replicate[c] / effort.samples;
                    sum[c] += mean;
                    squares[c] += mean * mean;
                }
            }
            const double R = effort.replicates;
            for (std::size_t c = 0; c < out.columns; ++c) {
                const double mean = sum[c] / R;
                const double variance = std::max(0.0, squares[c] / R - mean * mean) * R / (R - 1);
                out.mean[p * out.columns + c] = mean;
                out.standard_error[p * out.columns + c] = std::sqrt(variance / R);
            }
            rays += walk.rays;
        },
        1);
    out.paths = std::uint64_t{receivers.size()} * effort.samples * effort.replicates;
    out.rays = rays;
    return out;
}

}  // namespace exitance::truth
