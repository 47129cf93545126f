// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/facet_caster.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace exitance {

namespace {

using Corner = std::tuple<double, double, double>;

// The same for facets with the same corners in whatever order.
std::vector<Corner> place_of(const Facet& facet) {
    std::vector<Corner> key;
    for (const Vec3& c : facet.corners()) key.emplace_back(c.x, c.y, c.z);
    std::sort(key.begin(), key.end());
    return key;
}

RayCaster make_caster(const Enclosure& enclosure, const std::vector<BlockingFacet>& blockers) {
    std::vector<Vec3> points;
    std::vector<RayCaster::Face> faces;
    for (const BlockingFacet& blocker : blockers) {
        const Facet& facet = enclosure.facets[blocker.front];
        const auto first = static_cast<std::uint32_t>(points.size());
        for (const Vec3& corner : facet.corners()) points.push_back(corner);
        faces.push_back({first, first + 1, first + 2, first + facet.count - 1});
    }
    return RayCaster(points, faces);
}

}  // namespace

std::vector<BlockingFacet> blocking_facets(const Enclosure& enclosure) {
    std::vector<BlockingFacet> blockers;
    std::map<std::vector<Corner>, std::size_t> known;
    for (std::size_t f = 0; f < enclosure.facets.size(); ++f) {
        const Facet& facet = enclosure.facets[f];
        const auto number = static_cast<std::uint32_t>(f);
        const auto [found, fresh] = known.try_emplace(place_of(facet), blockers.size());
        if (!fresh) {
            BlockingFacet& other = blockers[found->second];
            const bool opposite = dot(enclosure.facets[other.front].normal, facet.normal) < 0;
            if (opposite && other.back == BlockingFacet::none) other.back = number;
            continue;  // what is there twice is met once
        }
        blockers.push_back({number, BlockingFacet::none});
    }
    return blockers;
}

FacetCaster::FacetCaster(const Enclosure& enclosure)
    : blockers_(blocking_facets(enclosure)), rays_(make_caster(enclosure, blockers_)) {}

}  // namespace exitance
