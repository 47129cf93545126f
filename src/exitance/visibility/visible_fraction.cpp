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
constexpr std::size_t most_samples = RayBudget::largest;

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
    std::array<float, width> kernel, disk;  // weights of the answer, 0 below either horizon
};

using Pattern = std::array<std::uint32_t, ReceiverBlock::capacity>;

// A quad is P(u, v) = a + u b + v c + uv d, with |∂P/∂u × ∂P/∂v| = j0 + u ju + v jv; a triangle
// folds the unit square by the square root (area-preserving).
struct Parametrisation {
    Vec3f a, b, c, d;
    float j0, ju, jv;
    float fold;  // 1 for a triangle, 0 for a quad

    explicit Parametrisation(const Source& s) {
        const bool triangle = s.count == 3;
        a = s.corners[0];
        b = s.corners[1] - a;
        c = (triangle ? s.corners[2] : s.corners[3]) - a;
        d = triangle ? Vec3f{} : s.corners[2] - a - b - c;
        j0 = dot(s.normal, cross(b, c));
        ju = dot(s.normal, cross(b, d));
        jv = dot(s.normal, cross(d, c));
        fold = triangle ? 1.0f : 0.0f;
    }
};

// max(x, 0) without a comparison, which would keep the loop from being vectorised.
[[gnu::always_inline]] inline float positive_part(float x) {
    return 0.5f * (x + std::abs(x));
}

EXITANCE_MULTIVERSION
void aim(Task& task, RayPacket& rays, const Source& source, const Parametrisation& map,
         float clearance, const ReceiverBlock& receivers, const Pattern& pattern_u,
         const Pattern& pattern_v) {
    const float ex = source.normal.x * clearance, ey = source.normal.y * clearance,
                ez = source.normal.z * clearance;
    alignas(64) float x[width], y[width], z[width], nx[width], ny[width], nz[width];
    alignas(64) std::int32_t bits_u[width], bits_v[width];
    for (std::size_t i = 0; i < width; ++i) {
        const std::uint32_t r = task.owner[i], sample = task.sample[i];
        x[i] = receivers.x[r], y[i] = receivers.y[r], z[i] = receivers.z[r];
        nx[i] = receivers.nx[r], ny[i] = receivers.ny[r], nz[i] = receivers.nz[r];
        bits_u[i] = static_cast<std::int32_t>((sobol_points[0][sample] ^ pattern_u[r]) >> 8);
        bits_v[i] = static_cast<std::int32_t>((sobol_points[1][sample] ^ pattern_v[r]) >> 8);
    }
    // By value: as references they might alias what the loop writes.
    const float ax = map.a.x + ex, ay = map.a.y + ey, az = map.a.z + ez;
    const float bx = map.b.x, by = map.b.y, bz = map.b.z;
    const float cx = map.c.x, cy = map.c.y, cz = map.c.z;
    const float wx = map.d.x, wy = map.d.y, wz = map.d.z;
    const float j0 = map.j0, ju = map.ju, jv = map.jv, fold = map.fold;
    const float mx = source.normal.x, my = source.normal.y, mz = source.normal.z;
    const float area = source.area;
#pragma GCC unroll 1  // left to the vectoriser as a loop
    for (std::size_t i = 0; i < width; ++i) {
        const float s = static_cast<float>(bits_u[i]) * 0x1.0p-24f;
        const float t = static_cast<float>(bits_v[i]) * 0x1.0p-24f;
        const float root = std::sqrt(s);
        const float u = s + fold * (root * (1.0f - t) - s);
        const float v = t + fold * (root * t - t);
        const float ox = x[i] + nx[i] * clearance;
        const float oy = y[i] + ny[i] * clearance;
        const float oz = z[i] + nz[i] * clearance;
        const float uv = u * v;
        // Both ends stand clear of their surfaces, so that neither blocks its own light.
        const float dx = ax + u * bx + v * cx + uv * wx - ox;
        const float dy = ay + u * by + v * cy + uv * wy - oy;
        const float dz = az + u * bz + v * cz + uv * wz - oz;
        const float jacobian = j0 + u * ju + v * jv;
        const float receive = dx * nx[i] + dy * ny[i] + dz * nz[i];
        const float send = -(dx * mx + dy * my + dz * mz);
        const float square = dx * dx + dy * dy + dz * dz + 1e-30f;
        const float cosines = positive_part(receive) * positive_part(send) / square;
        task.kernel[i] = cosines / square * jacobian;
        task.disk[i] =
            area * cosines / (std::numbers::pi_v<float> * square + area * task.inverse_samples[i]);
        rays.origin_x[i] = ox, rays.origin_y[i] = oy, rays.origin_z[i] = oz;
        rays.direction_x[i] = dx, rays.direction_y[i] = dy, rays.direction_z[i] = dz;
        rays.near[i] = 0.0f, rays.far[i] = 1.0f;
    }
}

struct Sums {
    float kernel = 0, seen = 0, disk = 0;
    std::uint16_t samples = 0;
    bool any_seen = false, any_hidden = false, uneven = false;  // uneven: through other glass
    float through = -1;                                         // of the first that was seen
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
    const bool glass = occlusion && caster.has_glass();
    std::array<float, width> through;
    through.fill(1.0f);
    const auto cast = [&] {
        for (std::size_t i = filled; i < width; ++i) {  // idle lanes repeat the first
            task.owner[i] = task.owner[0], task.sample[i] = task.sample[0];
            task.inverse_samples[i] = task.inverse_samples[0];
        }
        aim(task, rays, source, map, clearance, receivers, pattern_u, pattern_v);
        rays.active = 0;
        for (std::size_t i = 0; i < filled; ++i)
            rays.active |= (task.kernel[i] > 0.0f ? 1u : 0u) << i;
        // Places of the source that another polygon owns are hidden without asking.
        std::uint32_t covered = 0;
        for (const Cover& cover : source.covers)
            for (std::size_t i = 0; i < filled; ++i)
                if (cover.contains({rays.origin_x[i] + rays.direction_x[i],
                                    rays.origin_y[i] + rays.direction_y[i],
                                    rays.origin_z[i] + rays.direction_z[i]}))
                    covered |= 1u << i;
        std::uint32_t blocked = covered;
        if (rays.active && occlusion)
            blocked |= glass ? caster.occluded(rays, through) : caster.occluded(rays);
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
                sum.seen += task.kernel[i] * through[i];
                sum.disk += task.disk[i] * through[i];
                sum.uneven = sum.uneven || (sum.through >= 0 && sum.through != through[i]);
                sum.through = through[i];
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
            const bool undecided =  // both, or neither
                sums[r].any_seen == sums[r].any_hidden || sums[r].uneven;
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
        const bool partly = (sum.any_seen && sum.any_hidden) || sum.uneven;
        const float root = partly ? std::sqrt(std::sqrt(static_cast<float>(sum.samples))) : 1.0f;
        out.deviation[r] = partly ? 0.5f / (root * root * root) : 0.0f;
    }
}

}  // namespace exitance
