// SPDX-License-Identifier: Apache-2.0
#include "exitance/transport/luminaire_column.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
#include "exitance/transport/ray_count.h"

namespace exitance {

namespace {

constexpr std::size_t width = RayPacket::width;

/// Shadow rays of one receiver towards places of the opening.
struct Visibility {
    double seen = 0, all = 0;
    std::uint32_t samples = 0;
    bool any_seen = false, any_hidden = false, uneven = false;  ///< uneven: through other glass
    float through = -1;                                         ///< of the last that was seen
    bool partly() const { return (any_seen && any_hidden) || uneven; }
};

class Rays {
  public:
    Rays(const RayCaster& caster, bool occlusion) : caster_(caster), occlusion_(occlusion) {
        packet_.near.fill(0.0f), packet_.far.fill(1.0f);
        through_.fill(1.0f);
        packet_.active = 0;
    }

    /// `from` and `to` relative to the middle of the scene, both clear of surfaces.
    void add(const Vec3& from, const Vec3& to, double weight, Visibility& receiver) {
        packet_.aim(filled_, from, to - from);
        weight_[filled_] = weight;
        receiver_[filled_] = &receiver;
        if (++filled_ == width) flush();
    }

    void flush() {
        if (filled_ == 0) return;
        const std::uint32_t blocked = occlusion_ ? caster_.occluded(packet_, through_) : 0;
        if (occlusion_) count += filled_;
        for (std::size_t i = 0; i < filled_; ++i) {
            Visibility& v = *receiver_[i];
            v.all += weight_[i];
            const bool hidden = blocked >> i & 1u;
            (hidden ? v.any_hidden : v.any_seen) = true;
            if (hidden) continue;
            v.seen += weight_[i] * double(through_[i]);
            v.uneven = v.uneven || (v.through >= 0 && v.through != through_[i]);
            v.through = through_[i];
        }
        filled_ = 0;
        packet_.active = 0;
    }

    std::uint64_t count = 0;

  private:
    const RayCaster& caster_;
    bool occlusion_;
    RayPacket packet_;
    std::size_t filled_ = 0;
    std::array<double, width> weight_{};
    std::array<float, width> through_;
    std::array<Visibility*, width> receiver_{};
};

}  // namespace

std::uint64_t compute_luminaire_column(const RayCaster& caster, const LuminaireSource& source,
                                       double tolerance, std::uint32_t number,
                                       const Receivers& receivers,
                                       std::span<const std::uint32_t> which,
                                       const ColumnOptions& options, std::span<ColumnEntry> entries,
                                       std::span<const float> irradiance) {
    std::atomic<std::uint64_t> rays{0};
    const Vec3 middle = caster.middle();
    const double clearance = caster.clearance();
    constexpr std::size_t block = 256;
    parallel_blocks(which.size(), block, [&](std::size_t begin, std::size_t end) {
        const std::size_t n = end - begin;
        std::array<Visibility, block> visible{};
        std::array<std::uint32_t, block> goal{}, most{};
        std::array<Vec3, block> points, normals;
        Rays packets(caster, options.occlusion);
        LuminaireSource::View view;
        for (std::size_t i = 0; i < n; ++i) {
            const std::uint32_t r = which[begin + i];
            normals[i] = Vec3(receivers.normal(r));
            points[i] = Vec3(receivers.point(r)) + middle;
            const double light = irradiance.empty() ? source.irradiance(points[i], normals[i])
                                                    : double(irradiance[begin + i]);
            entries[begin + i] = {static_cast<float>(light), 1.0f, 0.0f};
            if (!(light > 0)) continue;
            most[i] =
                source.is_point() ? 1 : static_cast<std::uint32_t>(rays_for(light / tolerance));
            goal[i] = std::clamp(most[i] / 2, 1u, 64u);
        }
        // First the probes; then, where they disagreed, twice as many as so far until `most`.
        for (bool more = true; more;) {
            for (std::size_t i = 0; i < n; ++i) {
                Visibility& v = visible[i];
                const std::uint64_t key =
                    hash_bits(options.seed, number, receivers.key[which[begin + i]]);
                if (v.samples < goal[i]) source.look(points[i], view);
                for (; v.samples < goal[i]; ++v.samples) {
                    const auto [a, b] = low_discrepancy(key, v.samples);
                    const auto s = source.sample(view, points[i], normals[i], a, b);
                    if (!(s.weight > 0)) continue;
                    packets.add(points[i] + normals[i] * clearance - middle,
                                s.place + s.normal * clearance - middle, s.weight, v);
                }
            }
            packets.flush();
            more = false;
            for (std::size_t i = 0; i < n; ++i) {
                const bool undecided =
                    visible[i].any_seen == visible[i].any_hidden || visible[i].uneven;
                if (!undecided || goal[i] >= most[i]) continue;
                goal[i] = std::min(most[i], std::max(8u, 2 * goal[i]));
                more = true;
            }
        }
        for (std::size_t i = 0; i < n; ++i) {
            const Visibility& v = visible[i];
            if (!(v.all > 0)) continue;
            ColumnEntry& entry = entries[begin + i];
            entry.visible = static_cast<float>(v.seen / v.all);
            if (v.partly()) entry.deviation = penumbra_deviation(v.samples);
        }
        rays.fetch_add(packets.count, std::memory_order_relaxed);
    });
    return rays.load();
}

}  // namespace exitance
