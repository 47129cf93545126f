// SPDX-License-Identifier: Apache-2.0
#include "exitance/transport/column.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "exitance/formfactor/obstacles.h"
#include "exitance/formfactor/point_polygon_block.h"
#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
#include "exitance/transport/ray_count.h"
#include "exitance/visibility/visible_fraction.h"

namespace exitance {

namespace {

// Half of the rays, within limits, find out whether there is a penumbra at all.
RayBudget budget_for(const float* factors, std::size_t size, float brightness,
                     const ColumnOptions& options) {
    RayBudget budget;
    for (std::size_t r = 0; r < size; ++r) {
        const float most = rays_for(factors[r] * brightness, float(options.most_rays));
        budget.most[r] = static_cast<std::uint16_t>(most);
        budget.probe[r] = factors[r] > 0.0f ? static_cast<std::uint8_t>(std::clamp(
                                                  most / 2.0f, 1.0f, float(options.most_probes)))
                                            : std::uint8_t{0};
    }
    return budget;
}

}  // namespace

std::uint64_t compute_column(const RayCaster& caster, const Source& source, float brightness,
                             std::uint32_t number, const Receivers& receivers,
                             std::span<const std::uint32_t> which, const ColumnOptions& options,
                             std::span<ColumnEntry> entries) {
    std::atomic<std::uint64_t> rays{0};
    const auto seed = static_cast<std::uint32_t>(hash_bits(options.seed, number));
    parallel_blocks(which.size(), ReceiverBlock::capacity, [&](std::size_t begin, std::size_t end) {
        ReceiverBlock block;
        block.load(receivers, &which[begin], end - begin);
        alignas(64) std::array<float, ReceiverBlock::capacity> factors;
        point_polygon_factors(block, source, static_cast<float>(caster.clearance()),
                              factors.data());
        for (std::size_t r = 0; r < block.size; ++r) entries[begin + r] = {factors[r], 1.0f, 0.0f};
        const bool disk = options.factor == PointFactor::disk;
        if (!options.occlusion && !disk) return;

        RayBudget budget = budget_for(factors.data(), block.size, brightness, options);
        if (options.obstacles && !disk && source.covers.empty()) {
            ViewsOfSource views;
            view_source(*options.obstacles, source, block, budget.probe, caster.clearance(), views);
            for (std::size_t r = 0; r < block.size; ++r) {
                if (!views.known[r]) continue;
                entries[begin + r].visible = views.visible[r];
                budget.probe[r] = 0;
            }
        }
        // A disc stands for its share of the source only from afar: near sources need more of them.
        for (std::size_t r = 0; disk && r < block.size; ++r) {
            if (!budget.probe[r]) continue;
            const auto discs = std::max<float>(budget.most[r], std::ceil(64.0f * factors[r]));
            budget.most[r] = static_cast<std::uint16_t>(std::min(discs, 255.0f));
            budget.probe[r] = static_cast<std::uint8_t>(budget.most[r]);
        }
        VisibleFractions seen;
        find_visible_fractions(caster, source, block, budget, options.occlusion, seed, seen);
        for (std::size_t r = 0; r < block.size; ++r) {
            if (!budget.probe[r]) continue;
            ColumnEntry& entry = entries[begin + r];
            entry.visible = seen.fraction[r];
            entry.deviation = seen.deviation[r];
            if (disk && seen.fraction[r] > 0) entry.factor = seen.disk[r] / seen.fraction[r];
        }
        rays.fetch_add(seen.rays, std::memory_order_relaxed);
    });
    return rays.load();
}

}  // namespace exitance
