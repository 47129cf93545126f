// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/pairs_of_facets.h"

#include <algorithm>

namespace exitance {

namespace {

bool before(const Facet& a, const Facet& b) {
    const auto corners = b.corners();
    return std::any_of(corners.begin(), corners.end(),
                       [&](const Vec3& c) { return dot(c - a.outline[0], a.normal) > 0; });
}

}  // namespace

std::vector<std::vector<std::uint32_t>> facets_of_rows(const Enclosure& enclosure) {
    std::vector<std::vector<std::uint32_t>> facets(enclosure.surfaces.size());
    for (std::size_t f = 0; f < enclosure.facets.size(); ++f)
        if (enclosure.facets[f].row != Facet::only_blocks)
            facets[enclosure.facets[f].row].push_back(static_cast<std::uint32_t>(f));
    return facets;
}

bool may_see(const Facet& a, const Facet& b) {
    return before(a, b) && before(b, a);
}

}  // namespace exitance
