// SPDX-License-Identifier: Apache-2.0
#include "exitance/visibility/visible_fraction.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exitance/math/multiversion.h"
#include "exitance/run/random.h"

namespace exitance {

namespace {

constexpr std::size_t width = RayPacket::width;
constexpr std::size_t most_samples = 256;

// The first points of Sobol's sequence; a receiver's own pattern is an exclusive-or away.
constexpr auto sobol_points = [] {
    std::array<std::array<std::uint32_t, most_samples>, 2> points{};
    for (std::uint32_t i = 0; i < most_samples; ++i)
        points[0][i] = sobol(i)[0], points[1][i] = sobol(i)[1];
    return points;
}();

constexpr std::uint32_t scramble(std::uint32_t key, std::uint32_t salt) {
    return static_cast<std::uint32_t>(hash_bits(std::uint64_t{key} << 32 | salt));
}

// One packet: which receivers, which sample of each.
struct alignas(64) Task {
    std::array<std::uint32_t, width> owner, sample;
    std::array<float, width> inverse_samples;
    std::array<float, width> kernel, disk;  // weights of the answer
    std::array<std::int32_t, width> above;  // sample above both horizons
};

using Pattern = std::array<std::uint32_t, ReceiverBlock::capacity>;

// A quad is P(u, v) = a + u b + v c + uv d, with |∂P/∂u × ∂P/∂v| = j0 + u ju + v jv; a triangle
// folds the unit square by the square root (area-preserving).
struct Parametrisation {
    Vec3f a, b, c, d;
    float j0, ju, jv;
    bool triangle;

    explicit Parametrisation(const Source& s) : triangle(s.count == 3) {
        a = s.corners[0];
        b = s.corners[1] - a;
        c = (triangle ? s.corners[2] : s.corners[3]) - a;
        d = triangle ? Vec3f{} : s.corners[2] - a - b - c;
        j0 = dot(s.normal, cross(b, c));
        ju = dot(s.normal, cross(b, d));
        jv = dot(s.normal, cross(d, c));
    }
};

EXITANCE_MULTIVERSION
void aim(Task& task, RayPacket& rays, const Source& source, const Parametrisation& map,
         float clearance, const ReceiverBlock& receivers, const Pattern& pattern_u,
         const Pattern& pattern_v) {
    const float ex = source.normal.x * clearance, ey = source.normal.y * clearance,
                ez = source.normal.z * clearance;
    for (std::size_t i = 0; i < width; ++i) {
        const std::uint32_t r = task.owner[i];
        const std::uint32_t bits_u = sobol_points[0][task.sample[i]] ^ pattern_u[r];
        const std::uint32_t bits_v = sobol_points[1][task.sample[i]] ^ pattern_v[r];
        float u = static_cast<float>(static_cast<std::int32_t>(bits_u >> 8)) * 0x1.0p-24f;
        float v = static_cast<float>(static_cast<std::int32_t>(bits_v >> 8)) * 0x1.0p-24f;
        const float nx = receivers.nx[r], ny = receivers.ny[r], nz = receivers.nz[r];
        if (map.triangle) {
            const float s = std::sqrt(u);
            u = s * (1.0f - v), v = s * v;
        }
        const float ox = receivers.x[r] + nx * clearance;
        const float oy = receivers.y[r] + ny * clearance;
        const float oz = receivers.z[r] + nz * clearance;
        const float uv = u * v;
        // Both ends stand clear of their surfaces, so that neither blocks its own light.
        const float dx = map.a.x + u * map.b.x + v * map.c.x + uv * map.d.x + ex - ox;
        const float dy = map.a.y + u * map.b.y + v * map.c.y + uv * map.d.y + ey - oy;
        const float dz = map.a.z + u * map.b.z + v * map.c.z + uv * map.d.z + ez - oz;
        const float jacobian = map.triangle ? 1.0f : map.j0 + u * map.ju + v * map.jv;
        const float receive = dx * nx + dy * ny + dz * nz;
        const float send = -(dx * source.normal.x + dy * source.normal.y + dz * source.normal.z);
        const float square = dx * dx + dy * dy + dz * dz + 1e-30f;
        const float cosines = std::max(receive, 0.0f) * std::max(send, 0.0f) / square;
        task.kernel[i] = cosines / square * jacobian;
        task.disk[i] = source.area * cosines /
                       (std::numbers::pi_v<float> * square + source.area * task.inverse_samples[i]);
        task.above[i] = cosines > 0.0f ? 1 : 0;
        rays.origin_x[i] = ox, rays.origin_y[i] = oy, rays.origin_z[i] = oz;
        rays.direction_x[i] = dx, rays.direction_y[i] = dy, rays.direction_z[i] = dz;
        rays.near[i] = 0.0f, rays.far[i] = 1.0f;
    }
}

struct Sums {
    float kernel = 0, seen = 0, disk = 0;
    std::uint16_t samples = 0;
    bool any_seen = false, any_hidden = false;
};

}  // namespace

void find_visible_fractions(const RayCaster& caster, const Source& source,
                            const ReceiverBlock& receivers, const RayBudget& budget, bool occlusion,
                            std::uint32_t seed, VisibleFractions& out) {
    const Parametrisation map(source);
    const auto clearance = static_cast<float>(caster.clearance());
    std::array<Sums, ReceiverBlock::capacity> sums{};
    Pattern pattern_u, pattern_v;
    std::array<std::uint8_t, ReceiverBlock::capacity> open;  // receivers still wanting rays
    std::size_t open_count = 0;
    for (std::size_t r = 0; r < receivers.size; ++r) {
        if (budget.probe[r] == 0) continue;
        const std::uint32_t own = scramble(receivers.key[r], seed);
        pattern_u[r] = own, pattern_v[r] = scramble(own, seed);
        open[open_count++] = static_cast<std::uint8_t>(r);
    }

    Task task;
    RayPacket rays;
    std::size_t filled = 0;
    const auto cast = [&] {
        for (std::size_t i = filled; i < width; ++i) {  // idle lanes repeat the first
            task.owner[i] = task.owner[0], task.sample[i] = task.sample[0];
            task.inverse_samples[i] = task.inverse_samples[0];
        }
        aim(task, rays, source, map, clearance, receivers, pattern_u, pattern_v);
        rays.active = 0;
        for (std::size_t i = 0; i < filled; ++i)
            rays.active |= static_cast<std::uint32_t>(task.above[i]) << i;
        // Places of the source that another polygon owns are hidden without asking.
        std::uint32_t covered = 0;
        for (const Cover& cover : source.covers)
            for (std::size_t i = 0; i < filled; ++i)
                if (cover.contains({rays.origin_x[i] + rays.direction_x[i],
                                    rays.origin_y[i] + rays.direction_y[i],
                                    rays.origin_z[i] + rays.direction_z[i]}))
                    covered |= 1u << i;
        const std::uint32_t blocked =
            covered | (rays.active && occlusion ? caster.occluded(rays) : 0);
        if (occlusion) out.rays += static_cast<std::uint64_t>(__builtin_popcount(rays.active));
        for (std::size_t i = 0; i < filled; ++i) {
            Sums& sum = sums[task.owner[i]];
            ++sum.samples;
            if (!(rays.active >> i & 1u)) continue;
            sum.kernel += task.kernel[i];
            if (blocked >> i & 1u) {
                sum.any_hidden = true;
            } else {
                sum.any_seen = true;
                sum.seen += task.kernel[i];
                sum.disk += task.disk[i];
            }
        }
        filled = 0;
    };

    // First the probes; then, where they disagreed, twice as many as so far until `most`.
    std::array<std::uint16_t, ReceiverBlock::capacity> goal{};
    for (std::size_t k = 0; k < open_count; ++k) goal[open[k]] = budget.probe[open[k]];
    out.rays = 0;
    while (open_count > 0) {
        // Sample-major: neighbouring receivers aim at neighbouring places.
        std::uint16_t first = most_samples, last = 0;
        for (std::size_t k = 0; k < open_count; ++k) {
            first = std::min(first, sums[open[k]].samples);
            last = std::max(last, goal[open[k]]);
        }
        std::array<std::uint16_t, ReceiverBlock::capacity> from;
        for (std::size_t k = 0; k < open_count; ++k) from[open[k]] = sums[open[k]].samples;
        for (std::uint16_t s = first; s < last; ++s) {
            for (std::size_t k = 0; k < open_count; ++k) {
                const std::uint8_t r = open[k];
                if (s < from[r] || s >= goal[r]) continue;
                task.owner[filled] = r;
                task.sample[filled] = s;
                task.inverse_samples[filled] = 1.0f / static_cast<float>(goal[r]);
                if (++filled == width) cast();
            }
        }
        if (filled > 0) cast();
        std::size_t kept = 0;
        for (std::size_t k = 0; k < open_count; ++k) {
            const std::uint8_t r = open[k];
            const bool undecided = sums[r].any_seen == sums[r].any_hidden;  // both, or neither
            if (!undecided || goal[r] >= budget.most[r]) continue;
            goal[r] = std::min<std::uint16_t>(budget.most[r],
                                              static_cast<std::uint16_t>(std::max(8, 2 * goal[r])));
            open[kept++] = r;
        }
        open_count = kept;
    }
    for (std::size_t r = 0; r < receivers.size; ++r) {
        const Sums& sum = sums[r];
        // No sample above the horizon: a sliver that nothing was found to hide.
        out.fraction[r] = sum.kernel > 0 ? sum.seen / sum.kernel : 1.0f;
        out.disk[r] = sum.samples ? sum.disk / static_cast<float>(sum.samples) : 0.0f;
    }
}

}  // namespace exitance
