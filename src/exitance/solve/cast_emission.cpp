// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/cast_emission.h"

#include <algorithm>
#include <atomic>
#include <vector>

#include "exitance/formfactor/point_polygon_block.h"
#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
#include "exitance/solve/distant_cast.h"
#include "exitance/transport/luminaire_column.h"

namespace exitance {

namespace {

// Lamps of one branch that bring a receiver less than this share of the tolerance together may be
// seen and hidden as one of them is: as exact as the one ray that a faint source deserves.
constexpr float shared_share = 0.125f;
// Numbers per thread at most: lamps × receivers of a block.
constexpr std::size_t most_numbers = std::size_t{1} << 22;
constexpr std::size_t least_block = 16;

/// From all lamps to a block of receivers, on one thread.
class LampShot {
  public:
    LampShot(const Radiosity& radiosity, const Lamps& lamps, const Receivers& receivers,
             std::span<const std::uint32_t> which, float tolerance, const ColumnOptions& options,
             Received& received)
        : radiosity_(radiosity),
          lamps_(lamps),
          receivers_(receivers),
          which_(which),
          tolerance_(tolerance),
          options_(options),
          received_(received) {}

    std::uint64_t cast() {
        find_unblocked();
        choose();
        std::sort(views_.begin(), views_.end(), [](const View& a, const View& b) {
            return a.lamp != b.lamp ? a.lamp < b.lamp : a.receiver < b.receiver;
        });
        last_.assign(which_.size(), {});
        for (std::size_t first = 0, end = 0; first < views_.size(); first = end) {
            while (end < views_.size() && views_[end].lamp == views_[first].lamp) ++end;
            cast_lamp(views_[first].lamp, std::span(views_).subspan(first, end - first));
        }
        return rays_;
    }

  private:
    // A receiver looks for one lamp, which stands for all of its branch.
    struct View {
        std::uint32_t lamp, receiver, begin, end;  ///< receiver: of the block
        bool alone() const { return end - begin == 1; }
    };

    float& unblocked(std::size_t lamp, std::size_t i) {
        return unblocked_[lamp * which_.size() + i];
    }

    void find_unblocked() {
        const std::size_t n = which_.size();
        unblocked_.resize(lamps_.size() * n);
        ReceiverBlock block;
        block.load(receivers_, which_.data(), n);
        alignas(64) std::array<float, ReceiverBlock::capacity> factors;
        const Vec3 middle = radiosity_.caster.middle();
        for (std::size_t l = 0; l < lamps_.size(); ++l) {
            const Lamp& lamp = lamps_.all()[l];
            if (lamp.polygon)
                point_polygon_factors(block, *lamp.polygon,
                                      static_cast<float>(radiosity_.caster.clearance()),
                                      factors.data());
            else
                for (std::size_t i = 0; i < n; ++i)
                    factors[i] = static_cast<float>(
                        lamp.luminaire->irradiance(Vec3(receivers_.point(which_[i])) + middle,
                                                   Vec3(receivers_.normal(which_[i]))));
            std::copy_n(factors.begin(), n, &unblocked(l, 0));
        }
    }

    // The largest branches that may share a view.
    void choose() {
        const auto branches = lamps_.branches();
        const bool share = options_.occlusion && options_.factor == PointFactor::lambert;
        const float enough = share ? shared_share * tolerance_ : 0.0f;
        light_of_branch_.resize(branches.size());
        for (std::size_t i = 0; i < which_.size(); ++i) {
            for (std::size_t b = branches.size(); b-- > 0;)
                light_of_branch_[b] =
                    branches[b].right
                        ? light_of_branch_[b + 1] + light_of_branch_[branches[b].right]
                        : unblocked(branches[b].begin, i) * lamps_.all()[branches[b].begin].level;
            const auto visit = [&](const auto& self, std::uint32_t b) -> void {
                const Lamps::Branch& branch = branches[b];
                if (!(light_of_branch_[b] > 0)) return;
                if (branch.right && light_of_branch_[b] > enough) {
                    self(self, b + 1);
                    self(self, branch.right);
                    return;
                }
                views_.push_back(
                    {pick(b, i), static_cast<std::uint32_t>(i), branch.begin, branch.end});
            };
            for (const std::uint32_t root : lamps_.roots()) visit(visit, root);
        }
    }

    // A lamp of a branch by what it would send. Neighbours pick alike: errors look smooth.
    std::uint32_t pick(std::uint32_t b, std::size_t i) {
        const Lamps::Branch& branch = lamps_.branches()[b];
        float left =
            static_cast<float>(uniform(hash_bits(options_.seed, b), 0)) * light_of_branch_[b];
        std::uint32_t last = branch.begin;
        for (std::uint32_t l = branch.begin; l < branch.end; ++l) {
            const float here = unblocked(l, i) * lamps_.all()[l].level;
            if (!(here > 0)) continue;
            last = l;
            left -= here;
            if (left < 0) break;
        }
        return last;
    }

    void cast_lamp(std::uint32_t l, std::span<const View> views) {
        const Lamp& lamp = lamps_.all()[l];
        alone_.clear(), near_.clear(), shared_.clear();
        for (const View& view : views) {
            if (!view.alone())
                shared_.push_back(view.receiver);
            else
                (lamp.face.valid() && fills_view(*lamp.polygon, receivers_, which_[view.receiver])
                     ? near_
                     : alone_)
                    .push_back(view.receiver);
        }
        if (look(l, alone_))
            received_.add(looking_, entries_, lamp.emitted, lamp.level, lamp.level);
        if (!near_.empty())
            rays_ +=
                cast_light(radiosity_.caster, emission_of(radiosity_, lamp.face), receivers_,
                           list(near_), tolerance_, options_, radiosity_.columns.stride, received_);
        if (!look(l, shared_)) return;
        std::size_t k = 0;
        for (const View& view : views)
            if (!view.alone()) add_branch(view, entries_[k++]);
    }

    // Of receivers of the block.
    std::span<const std::uint32_t> list(std::span<const std::uint32_t> receivers) {
        looking_.clear();
        for (const std::uint32_t i : receivers) looking_.push_back(which_[i]);
        return looking_;
    }

    // entries_ of receivers of the block; false if there are none.
    bool look(std::uint32_t l, std::span<const std::uint32_t> receivers) {
        if (receivers.empty()) return false;
        const Lamp& lamp = lamps_.all()[l];
        list(receivers);
        entries_.resize(receivers.size());
        if (lamp.polygon) {
            rays_ += compute_column(radiosity_.caster, *lamp.polygon, lamp.level / tolerance_,
                                    lamp.number, receivers_, looking_, options_, entries_);
            return true;
        }
        irradiance_.clear();
        for (const std::uint32_t i : receivers) irradiance_.push_back(unblocked(l, i));
        rays_ += compute_luminaire_column(radiosity_.caster, *lamp.luminaire,
                                          double(tolerance_) / double(lamp.level), lamp.number,
                                          receivers_, looking_, options_, entries_, irradiance_);
        return true;
    }

    void add_branch(const View& view, const ColumnEntry& entry) {
        const std::size_t stride = radiosity_.columns.stride;
        const std::uint32_t r = which_[view.receiver];
        float level = 0;
        for (std::uint32_t l = view.begin; l < view.end; ++l) {
            const Lamp& lamp = lamps_.all()[l];
            const float factor = unblocked(l, view.receiver);
            for (std::size_t c = 0; c < stride; ++c)
                received_.rows[r * stride + c] += entry.visible * factor * lamp.emitted[c];
            level += factor * lamp.level;
        }
        received_.light[r] += entry.visible * level;
        received_.unblocked[r] += level;
        // As its branch differs from the one before, so may the lamps of one.
        Last& last = last_[view.receiver];
        const float difference = last.known ? entry.visible - last.visible : 0.0f;
        received_.variance[r] +=
            level * level * (entry.deviation * entry.deviation + 0.5f * difference * difference);
        last = {entry.visible, true};
    }

    struct Last {
        float visible = 1;
        bool known = false;
    };

    const Radiosity& radiosity_;
    const Lamps& lamps_;
    const Receivers& receivers_;
    std::span<const std::uint32_t> which_;
    float tolerance_;
    const ColumnOptions& options_;
    Received& received_;
    std::uint64_t rays_ = 0;
    std::vector<float> unblocked_;  ///< lamps × receivers of the block, for an exitance of 1
    std::vector<float> light_of_branch_;
    std::vector<View> views_;
    std::vector<Last> last_;  ///< per receiver of the block: of its branches
    std::vector<std::uint32_t> alone_, near_, shared_;  ///< receivers of the block
    std::vector<std::uint32_t> looking_;                ///< some of those, by their own numbers
    std::vector<float> irradiance_;
    std::vector<ColumnEntry> entries_;
};

}  // namespace

std::uint64_t cast_lamps(const Radiosity& radiosity, const Lamps& lamps, const Receivers& receivers,
                         std::span<const std::uint32_t> which, float tolerance,
                         const ColumnOptions& options, Received& received) {
    if (lamps.size() == 0) return 0;
    std::atomic<std::uint64_t> rays{0};
    const std::size_t block =
        std::clamp(most_numbers / lamps.size(), least_block, ReceiverBlock::capacity);
    parallel_blocks(which.size(), block, [&](std::size_t begin, std::size_t end) {
        LampShot shot(radiosity, lamps, receivers, which.subspan(begin, end - begin), tolerance,
                      options, received);
        rays.fetch_add(shot.cast(), std::memory_order_relaxed);
    });
    return rays.load();
}

std::uint64_t cast_emission(const Radiosity& radiosity, const Lamps& lamps,
                            const Receivers& receivers, std::span<const std::uint32_t> which,
                            float tolerance, const ColumnOptions& options, Received& received) {
    std::uint64_t rays =
        cast_lamps(radiosity, lamps, receivers, which, tolerance, options, received);
    rays += cast_suns(radiosity, receivers, which, tolerance, options, received);
    received.note_seen();
    // The sky has no sharp shadows, and indoors it would hide what lamps and sun show of theirs.
    rays += cast_skies(radiosity, receivers, which, tolerance, options, received);
    return rays;
}

}  // namespace exitance
