// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/facing_parts.h"

#include <cmath>

namespace exitance {

std::vector<Vec3> clip_outline(std::span<const Vec3> outline, const Vec3& origin,
                               const Vec3& normal) {
    // Sutherland & Hodgman 1974, one plane.
    std::vector<Vec3> kept;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vec3 &p = outline[i], &q = outline[(i + 1) % outline.size()];
        const double hp = dot(p - origin, normal), hq = dot(q - origin, normal);
        if (hp >= 0) kept.push_back(p);
        if ((hp > 0 && hq < 0) || (hp < 0 && hq > 0))
            kept.push_back(p + (q - p) * (hp / (hp - hq)));
    }
    if (kept.size() < 3) kept.clear();
    return kept;
}

namespace {

// Corners within rounding of the plane are on it, so that facets that share an edge keep it whole.
std::vector<Vec3> part_before(const Facet& b, const Facet& a) {
    const double rounding = 1e-12 * std::sqrt(a.area + b.area);
    bool crosses = false, any = false;
    for (const Vec3& c : b.corners()) {
        const double h = dot(c - a.outline[0], a.normal);
        crosses |= h < -rounding;
        any |= h > rounding;
    }
    if (!any) return {};
    if (!crosses) return {b.corners().begin(), b.corners().end()};
    return clip_outline(b.corners(), a.outline[0], a.normal);
}

}  // namespace

FacingParts facing_parts(const Facet& a, const Facet& b) {
    FacingParts parts{part_before(a, b), part_before(b, a)};
    if (parts.a.empty() || parts.b.empty()) return {};
    return parts;
}

}  // namespace exitance
