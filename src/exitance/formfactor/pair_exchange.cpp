// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/pair_exchange.h"

#include <algorithm>
#include <cmath>

#include "exitance/formfactor/polygon_polygon.h"

namespace exitance {

PairExchanger::PairExchanger(double accuracy, double slack, double total_area)
    : accuracy_(accuracy),
      slack_(slack),
      total_area_(total_area),
      far_(4 * std::pow(1e-4 / accuracy, 1.0 / 6)) {}

double PairExchanger::free(const SampledFacet& a, const SampledFacet& b, bool wholly,
                           double by_points, double distance) {
    if (wholly && distance > far_) return by_points;
    return exchange_area(a.outline(), b.outline(), 0.1 * accuracy_);
}

namespace {

double distance(const Vec3& p, const Box& box) {
    const Vec3 nearest = max(box.lower, min(p, box.upper));
    return length(p - nearest);
}

}  // namespace

double PairExchanger::seen(const SampledFacet& a, const SampledFacet& b, bool wholly,
                           double by_points, double apart,
                           std::span<const Blocker* const> blockers) {
    // From the side that the blockers are farther from, shadows move less.
    double near_a = 1e300, near_b = 1e300;
    for (const Blocker* blocker : blockers) {
        near_a = std::min(near_a, distance(a.centre, blocker->bounds));
        near_b = std::min(near_b, distance(b.centre, blocker->bounds));
    }
    const bool from_a = a.radius * near_b <= b.radius * near_a;
    const SampledFacet &from = from_a ? a : b, &to = from_a ? b : a;
    const SmallPolygon points = clip(SmallPolygon(from.outline()), to.plane, slack_);
    const SmallPolygon target = clip(SmallPolygon(to.outline()), from.plane, slack_);
    if (points.empty() || target.empty()) return 0;

    obstacles_.clear();
    cut_.clear();
    cut_.reserve(blockers.size());
    if (rims_.size() < blockers.size()) rims_.resize(blockers.size());
    for (std::size_t k = 0; k < blockers.size(); ++k) {
        const Blocker* blocker = blockers[k];
        for (const Vec3& corner : blocker->corners)
            if (to.plane.height(corner) < -slack_) {
                auto before = cut(*blocker, to.plane, slack_);
                blocker = before ? &cut_.emplace_back(std::move(*before)) : nullptr;
                break;
            }
        if (!blocker) continue;
        const Stand stand =
            find_rims(*blocker, points.corners(), target.corners(), slack_, rims_[k]);
        if (stand == Stand::hides) {
            ++counters.hidden;
            return 0;
        }
        if (stand == Stand::between) obstacles_.push_back({blocker, rims_[k]});
    }
    if (obstacles_.empty()) {
        ++counters.visible;
        return free(a, b, wholly, by_points, apart);
    }
    ++counters.partial;
    const double least = std::min(a.area, b.area);
    const PartialTolerance tolerance{0.1 * accuracy_ * a.area * b.area / total_area_,
                                     0.4 * accuracy_ * std::sqrt(least)};
    const PartialExchange part =
        partial_(points, from.plane, target, to.plane, obstacles_, tolerance);
    counters.viewpoints = partial_.viewpoints;
    if (!part.by_hidden || (wholly && apart > 1.5)) return part.seen;
    return std::max(0.0, free(a, b, wholly, by_points, apart) - part.hidden);
}

}  // namespace exitance
