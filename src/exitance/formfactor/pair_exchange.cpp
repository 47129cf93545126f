// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/pair_exchange.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exitance/formfactor/polygon_polygon.h"

namespace exitance {

PairExchanger::PairExchanger(double accuracy, double slack, PairSampler sampler)
    : accuracy_(accuracy),
      slack_(slack),
      far_(4 * std::pow(1e-4 / accuracy, 1.0 / 6)),
      sampler_(std::move(sampler)) {}

double PairExchanger::free(const Pair& pair) {
    if (pair.wholly && pair.distance > far_) return pair.by_points;
    // Float, and Gauss points of one facet only, are good for a few millionths.
    if (pair.wholly && pair.distance > 1.2 && accuracy_ > 2e-5) {
        const bool from_a = pair.a->radius <= pair.b->radius;
        const SampledFacet &from = from_a ? *pair.a : *pair.b, &to = from_a ? *pair.b : *pair.a;
        return partial_.free(from.outline(), from.plane, to.outline(), to.plane);
    }
    return exchange_area(pair.a->outline(), pair.b->outline(), 0.1 * accuracy_);
}

namespace {

double distance(const Vec3& p, const Box& box) {
    const Vec3 nearest = max(box.lower, min(p, box.upper));
    return length(p - nearest);
}

// Whether rays are cheaper than exact views. A view meets each rim with every other one; most pairs
// need some ten packets of views. A ray costs what fifteen pairs of rims do.
bool is_cheaper_by_rays(std::span<const Obstacle> obstacles, double free, double tolerance) {
    double rims = 0;
    for (const Obstacle& obstacle : obstacles) rims += static_cast<double>(obstacle.rims.size());
    const double rays = std::max(128.0, std::pow(2 * tolerance / free, -4.0 / 3));
    return 15 * rays < 10 * rims * rims;
}

}  // namespace

double PairExchanger::seen(const Pair& pair, std::span<const Blocker* const> blockers,
                           double tolerance) {
    const SampledFacet &a = *pair.a, &b = *pair.b;
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
        // Edges that can be seen from the other side may tell what these cannot.
        if (stand == Stand::apart || find_rims(*blocker, target.corners(), points.corners(), slack_,
                                               back_rims_) == Stand::apart)
            continue;
        obstacles_.push_back({blocker, rims_[k]});
    }
    if (obstacles_.empty()) {
        ++counters.visible;
        return free(pair);
    }
    ++counters.partial;
    // Nothing is seen better through something.
    const double most = free(pair);
    if (is_cheaper_by_rays(obstacles_, most, tolerance)) {
        ++counters.sampled;
        return sampler_(pair, most, tolerance);
    }
    const PartialExchange part =
        partial_(points, from.plane, target, to.plane, obstacles_, tolerance);
    counters.viewpoints = partial_.viewpoints;
    return part.by_hidden ? std::max(0.0, most - part.hidden) : std::min(part.seen, most);
}

}  // namespace exitance
