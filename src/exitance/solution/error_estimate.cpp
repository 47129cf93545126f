// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/error_estimate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "exitance/math/warp.h"
#include "exitance/run/random.h"
#include "exitance/solution/gather.h"
#include "exitance/visibility/exposure.h"

namespace exitance {

namespace {

// There are more where these leave open whether the error is below the one looked for, or, if it is
// not, by how much.
constexpr std::size_t point_count = 640, most_points = 4 * point_count;
constexpr double well_known = 0.1;

// Of the points: how many are spread by light, and not by the square of its change.
constexpr double spread_by_light = 0.75;

// A gather of 512 rays misses by half a percent or so, and by n^-3/4 of that; it may miss by as
// much as the error that is looked for, whose square is averaged over hundreds of points.
GatherOptions rays_to_tell(double about) {
    const double rays = 512 * std::pow(0.01 / about, 4.0 / 3.0);
    const auto hemisphere = static_cast<std::uint32_t>(std::clamp(rays, 128.0, 1024.0));
    return {std::bit_ceil(hemisphere), std::max(64u, std::bit_ceil(hemisphere) / 2), 0};
}

/// How points are spread over the triangles that are of interest: `cumulative` is their share.
struct Spread {
    std::vector<std::uint32_t> triangles;
    std::vector<double> cumulative;
    std::vector<double> stands;   ///< what a point there stands for, against the mean of all
    double mean_reflectance = 0;  ///< area-weighted, luminance
};

/// Points, and what was found there.
struct HeldOut {
    std::vector<GatherPoint> points;
    std::vector<SurfacePlace> places;
    std::vector<double> stands;  ///< what a point stands for, against the mean of all
    std::vector<double> shown;   ///< of what the point counts: the share that is no echo
    std::vector<double> worth;   ///< that an error has where the point is shown
    std::vector<double> light;   ///< luminance of irradiance that the surface says
    std::vector<std::array<double, 2>> off;  ///< by how much that is above either gather
};

double triangle_area(const Solution& solution, std::size_t t) {
    const auto& [a, b, c] = solution.triangles[t];
    const Vec3 p(solution.positions[a]), q(solution.positions[b]), r(solution.positions[c]);
    return 0.5 * length(cross(q - p, r - p));
}

// Nobody asks what a lamp that reflects nothing receives.
bool is_of_interest(const Material& material) {
    return luminance(material.reflectance) > 0 || !material.emits();
}

// Irradiance (luminance) per vertex, relative to its mean over the surface.
std::vector<double> relative_light(const Solution& solution) {
    std::vector<double> out(solution.positions.size()), row(solution.columns());
    for (std::size_t v = 0; v < out.size(); ++v) {
        const auto H = solution.irradiance[VertexId(v)];
        std::copy_n(H.begin(), row.size(), row.begin());
        out[v] = std::max(0.0, solution.luminance(row));
    }
    double flux = 0, area = 0;
    for (std::size_t t = 0; t < solution.triangles.size(); ++t) {
        const double here = triangle_area(solution, t);
        area += here;
        for (const std::uint32_t v : solution.triangles[t]) flux += here / 3 * out[v];
    }
    for (double& light : out) light *= flux > 0 ? area / flux : 0.0;
    return out;
}

// Errors are large where there is much light, and where it changes: a few square centimetres below
// a lamp may have most of a scene's, and so may the shadow line of a point light, a thousandth of
// the area. Most points are spread over the area (or what it matters) in proportion to light and
// its change across a triangle, the others to the square of that change.
Spread spread_over(const Solution& solution, const TriangleImportance* importance) {
    Spread out;
    const std::vector<double> light = relative_light(solution);
    std::vector<double> areas, bright, uneven;
    double all_area = 0, all_bright = 0, all_uneven = 0, reflected = 0;
    for (const SolutionPart& part : solution.parts) {
        const double rho = luminance(solution.materials[part.material].reflectance);
        if (!is_of_interest(solution.materials[part.material])) continue;
        for (std::uint32_t k = 0; k < part.triangles; ++k) {
            const std::uint32_t t = part.first_triangle + k;
            const double matters =
                importance ? double(importance->weight[t]) + double(importance->echo[t]) : 1.0;
            const double area = matters * triangle_area(solution, t);
            if (!(area > 0)) continue;
            const auto& [a, b, c] = solution.triangles[t];
            const auto [low, high] = std::minmax({light[a], light[b], light[c]});
            const double mean = (light[a] + light[b] + light[c]) / 3;
            areas.push_back(area);
            bright.push_back(area * (1 + mean + (high - low)));
            uneven.push_back(area * (high - low) * (high - low));
            all_area += area, reflected += area * rho;
            all_bright += bright.back(), all_uneven += uneven.back();
            out.triangles.push_back(t);
        }
    }
    if (areas.empty()) return out;
    out.mean_reflectance = reflected / all_area;
    double sum = 0;
    for (std::size_t k = 0; k < areas.size(); ++k) {
        double share = bright[k] / all_bright;
        if (all_uneven > 0) share = std::lerp(uneven[k] / all_uneven, share, spread_by_light);
        out.cumulative.push_back(sum += share);
        out.stands.push_back(areas[k] / all_area / share);
    }
    return out;
}

// By systematic sampling.
HeldOut hold_out(const Solution& solution, const Spread& spread, std::uint64_t seed,
                 const TriangleImportance* importance) {
    HeldOut out;
    const auto& cumulative = spread.cumulative;
    for (std::size_t i = 0; i < point_count; ++i) {
        const double at =
            (static_cast<double>(i) + uniform(seed, 3 * i)) / point_count * cumulative.back();
        const auto above = static_cast<std::size_t>(
            std::upper_bound(cumulative.begin(), cumulative.end(), at) - cumulative.begin());
        const std::size_t k = std::min(above, cumulative.size() - 1);
        const std::uint32_t t = spread.triangles[k];
        const auto w = uniform_triangle({uniform(seed, 3 * i + 1), uniform(seed, 3 * i + 2)});
        const auto& corners = solution.triangles[t];
        Vec3 position, normal;
        for (std::size_t c = 0; c < 3; ++c) {
            position += Vec3(solution.positions[corners[c]]) * w[c];
            normal += Vec3(solution.normals[corners[c]]) * w[c];
        }
        out.points.push_back({position, normalized(normal)});
        out.places.push_back({t, {w[0], w[1], w[2]}});
        const double shown = importance ? double(importance->shown[t]) : 1.0;
        const double echo = importance ? double(importance->echo[t]) : 0.0;
        const double weight = importance ? double(importance->weight[t]) : 1.0;
        out.stands.push_back(spread.stands[k]);
        out.shown.push_back(weight / (weight + echo));
        out.worth.push_back(shown > 0 ? shown : 1.0);
    }
    return out;
}

// Points that lie under or inside other objects are nobody's to see.
void drop_buried(const Surfaces& surfaces, HeldOut& held) {
    const Solution& solution = surfaces.solution();
    std::vector<char> two_sided(solution.triangles.size());
    for (const SolutionPart& part : solution.parts)
        std::fill_n(two_sided.begin() + part.first_triangle, part.triangles,
                    solution.materials[part.material].two_sided);
    Receivers receivers;
    for (const GatherPoint& p : held.points)
        receivers.add(p.position - surfaces.caster().middle(), p.normal,
                      static_cast<std::uint32_t>(receivers.size()));
    std::vector<char> exposed(held.points.size());
    find_exposed(surfaces.caster(), two_sided, receivers, 0, exposed);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < exposed.size(); ++i) {
        if (!exposed[i]) continue;
        held.points[kept] = held.points[i];
        held.stands[kept] = held.stands[i];
        held.shown[kept] = held.shown[i];
        held.worth[kept] = held.worth[i];
        held.places[kept++] = held.places[i];
    }
    held.points.resize(kept);
    held.places.resize(kept);
    held.stands.resize(kept);
    held.shown.resize(kept);
    held.worth.resize(kept);
}

void compare(const Surfaces& surfaces, HeldOut& held, double about, std::uint64_t seed) {
    const Solution& solution = surfaces.solution();
    const std::size_t columns = solution.columns(), n = held.points.size();
    std::vector<double> first(n * columns), second(n * columns), told(columns);
    GatherOptions options = rays_to_tell(about);
    options.seed = hash_bits(seed, 1);
    gather(surfaces, held.points, first, options);
    options.seed = hash_bits(seed, 2);
    gather(surfaces, held.points, second, options);
    const auto level = [&](const double* row) { return solution.luminance({row, columns}); };
    for (std::size_t i = 0; i < n; ++i) {
        surfaces.irradiance(held.places[i], told);
        const double here = level(told.data());
        held.light.push_back(here);
        held.off.push_back({here - level(&first[i * columns]), here - level(&second[i * columns])});
    }
}

void append(HeldOut& all, const HeldOut& more) {
    const auto add = [](auto& to, const auto& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    add(all.stands, more.stands), add(all.shown, more.shown), add(all.worth, more.worth);
    add(all.light, more.light), add(all.off, more.off);
}

// `mean_reflectance` 0: what errors bring elsewhere is counted by their echo.
std::optional<ErrorEstimate> sum_up(const HeldOut& held, double mean_reflectance) {
    const std::size_t n = held.stands.size();
    double all_shown = 0;
    for (std::size_t i = 0; i < n; ++i) all_shown += held.stands[i] * held.shown[i];
    if (all_shown <= 0) return std::nullopt;
    double mean = 0, bias = 0, brought = 0, looked_at = 0;
    std::vector<double> squares(n);
    for (std::size_t i = 0; i < n; ++i) {
        const auto [a, b] = held.off[i];
        const double stands = held.stands[i], shown = stands * held.shown[i];
        mean += shown * (held.light[i] - 0.5 * (a + b)) / all_shown;
        bias += shown * 0.5 * (a + b) / all_shown;
        brought += (stands - shown) * 0.5 * (a + b) / all_shown;
        squares[i] = shown * held.worth[i] * a * b;
        looked_at += shown / held.worth[i];
    }
    if (!(mean > 0) || !std::isfinite(bias)) return std::nullopt;
    double square = 0, spread = 0;
    for (const double s : squares) square += s / looked_at;
    for (std::size_t i = 0; i < n; ++i) {
        const double expected = held.stands[i] * held.shown[i] / held.worth[i] * square;
        spread += (squares[i] - expected) * (squares[i] - expected);
    }
    // Every reflection repeats the mean error. It is known from some points only, which says too
    // much of its square by its variance, and is most of the doubt where much is reflected.
    const double times = 1.0 / (1.0 - std::min(mean_reflectance, 0.99));
    const double repeated = times * (bias + brought);
    double of_bias = 0, of_repeated = 0, of_both = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double off = 0.5 * (held.off[i][0] + held.off[i][1]);
        const double b = held.stands[i] * held.shown[i] * (off - bias) / all_shown;
        const double r = times * (held.stands[i] * (off - bias) / all_shown - brought / double(n));
        const double both = 2 * (repeated * r - bias * b);
        of_bias += b * b, of_repeated += r * r, of_both += both * both;
    }
    const double more = of_repeated - of_bias;
    const double total = std::max(0.0, square + repeated * repeated - bias * bias - more);
    ErrorEstimate out;
    out.points = static_cast<std::uint32_t>(n);
    out.rms = std::sqrt(total) / mean;
    // d√x = dx / 2√x; `spread` / n² is the variance of the mean square.
    const double deviation =
        std::sqrt(spread / (looked_at * looked_at) + of_both + 2 * more * more) / (mean * mean);
    out.confidence = out.rms > 0 ? deviation / (2 * out.rms) : std::sqrt(deviation);
    return out;
}

}  // namespace

std::optional<ErrorEstimate> estimate_error(const Solution& solution, std::uint64_t seed,
                                            double about, const TriangleImportance* importance) {
    const Spread spread = spread_over(solution, importance);
    if (spread.triangles.empty()) return std::nullopt;
    const Surfaces surfaces(solution, Backs::black);
    HeldOut all;
    std::optional<ErrorEstimate> found;
    for (std::size_t begin = 0; begin < most_points; begin += point_count) {
        HeldOut held = hold_out(solution, spread, hash_bits(seed, 0xe57u, begin), importance);
        drop_buried(surfaces, held);
        compare(surfaces, held, about, hash_bits(seed, begin));
        append(all, held);
        found = sum_up(all, importance ? 0.0 : spread.mean_reflectance);
        if (!found || found->rms + 2 * found->confidence < about) break;
        const bool missed = found->rms - 2 * found->confidence > about;
        if (missed && found->confidence < well_known * found->rms) break;
    }
    return found;
}

}  // namespace exitance
