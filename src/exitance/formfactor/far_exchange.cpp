// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/far_exchange.h"

#include <numbers>

#include "exitance/math/polygon.h"
#include "exitance/math/quadrature.h"

#define EXITANCE_LANES_SOURCE "exitance/formfactor/far_exchange_lanes.h"
#include "exitance/math/instruction_sets.h"

namespace exitance {

SampledFacet::SampledFacet(std::span<const Vec3> outline_)
    : count(static_cast<std::uint32_t>(outline_.size())), centre(centroid(outline_)) {
    for (std::size_t c = 0; c < 4; ++c) corners[c] = outline_[std::min(c, outline_.size() - 1)];
    radius = radius_about(centre, outline_);
    const Vec3 facing = vector_area(outline_);
    area = length(facing);
    plane.normal = normalized(facing);
    plane.offset = dot(plane.normal, centre);
    const auto& rule = gauss_legendre<2>();
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        // Bilinear from the unit square; for a triangle one side of it is a point.
        const double s = rule.at[k % 2], t = rule.at[k / 2];
        const Vec3 low = corners[0] + (corners[1] - corners[0]) * s;
        const Vec3 high = corners[3] + (corners[2] - corners[3]) * s;
        const Vec3 by_s = (corners[1] - corners[0]) * (1 - t) + (corners[2] - corners[3]) * t;
        points[k] = low + (high - low) * t;
        weights[k] = dot(cross(by_s, high - low), plane.normal);
        sum += weights[k];
    }
    for (double& w : weights) w *= area / sum;
}

void SampledBlock::set(std::size_t lane, const SampledFacet& facet) {
    outlines.set(lane, facet.corners, facet.plane);
    for (std::size_t k = 0; k < 4; ++k) {
        x[k][lane] = static_cast<float>(facet.points[k].x);
        y[k][lane] = static_cast<float>(facet.points[k].y);
        z[k][lane] = static_cast<float>(facet.points[k].z);
        weight[k][lane] = static_cast<float>(facet.weights[k]);
    }
    cx[lane] = static_cast<float>(facet.centre.x);
    cy[lane] = static_cast<float>(facet.centre.y);
    cz[lane] = static_cast<float>(facet.centre.z);
    radius[lane] = static_cast<float>(facet.radius);
}

void far_exchange(const SampledFacet& facet, const SampledBlock& block, float slack,
                  FarExchange& exchange) {
    EXITANCE_LANES_CALL(far_exchange)(facet, block, slack, exchange);
}

}  // namespace exitance
