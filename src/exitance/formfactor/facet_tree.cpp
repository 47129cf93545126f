// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/facet_tree.h"

#include <algorithm>
#include <numeric>

namespace exitance {

FacetExtent::FacetExtent(std::span<const SampledFacet> facets, std::span<const std::uint32_t> which,
                         double slack) {
    bool flat = true;
    const Plane& first = facets[which[0]].plane;
    for (const std::uint32_t i : which) {
        flat = flat && dot(facets[i].plane.normal, first.normal) > 0.5;
        for (const Vec3& corner : facets[i].outline()) {
            box.add(corner);
            flat = flat && std::abs(first.height(corner)) <= slack;
        }
    }
    if (flat) plane = first;
}

bool FacetExtent::turns_away_from(const FacetExtent& other, double slack) const {
    if (!plane) return false;
    const Vec3& n = plane->normal;
    const Box& b = other.box;
    const Vec3 highest{n.x > 0 ? b.upper.x : b.lower.x, n.y > 0 ? b.upper.y : b.lower.y,
                       n.z > 0 ? b.upper.z : b.lower.z};
    return plane->height(highest) <= slack;
}

namespace {

// 0 … 5: the axis that the normal is nearest to, and its sense.
std::uint64_t facing(const Vec3& n) {
    const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    const std::size_t axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    return axis * 2 + (n[axis] > 0 ? 1 : 0);
}

// Bits of `v` at every third place.
std::uint64_t spread(std::uint64_t v) {
    std::uint64_t out = 0;
    for (int k = 0; k < 20; ++k) out |= (v >> k & 1) << (3 * k);
    return out;
}

}  // namespace

std::uint64_t spatial_key(const SampledFacet& facet) {
    const auto cell = [](double x) {
        return static_cast<std::uint64_t>(std::clamp((x + 0.5) * 1048576, 0.0, 1048575.0));
    };
    return facing(facet.plane.normal) << 60 | spread(cell(facet.centre.x)) |
           spread(cell(facet.centre.y)) << 1 | spread(cell(facet.centre.z)) << 2;
}

FacetTree::FacetTree(std::span<const SampledFacet> facets, std::span<const std::uint32_t> rows,
                     double slack) {
    std::vector<std::uint32_t> order(facets.size());
    std::iota(order.begin(), order.end(), 0u);
    std::vector<std::uint64_t> sense(facets.size());
    for (std::size_t i = 0; i < facets.size(); ++i) sense[i] = facing(facets[i].plane.normal);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return sense[a] < sense[b]; });
    if (!order.empty()) build(order, facets, rows, slack);
}

void FacetTree::build(std::span<std::uint32_t> which, std::span<const SampledFacet> facets,
                      std::span<const std::uint32_t> rows, double slack) {
    const std::size_t at = nodes.size();
    Node node{FacetExtent(facets, which, slack), 0xffffffffU, 0, 0};
    for (const std::uint32_t i : which) node.least_row = std::min(node.least_row, rows[i]);
    nodes.push_back(node);
    constexpr std::size_t lanes = PolygonBlock::capacity;
    if (which.size() <= lanes) {
        nodes[at].block = static_cast<std::uint32_t>(blocks.size());
        Block& block = blocks.emplace_back();
        block.lanes.outlines.count = static_cast<std::uint32_t>(which.size());
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const std::uint32_t i = which[lane < which.size() ? lane : 0];
            block.facet[lane] = i;
            block.lanes.set(lane, facets[i]);
        }
        return;
    }
    // Facets that face alike stay together; then halves along the longest side, in whole blocks.
    const auto sense = [&](std::uint32_t i) { return facing(facets[i].plane.normal); };
    std::size_t middle = which.size() / 2;
    if (sense(which.front()) != sense(which.back())) {
        std::size_t low = middle, high = middle;
        while (low > 0 && sense(which[low - 1]) == sense(which[low])) --low;
        while (high < which.size() && sense(which[high - 1]) == sense(which[high])) ++high;
        middle = high < which.size() && (low == 0 || high - middle < middle - low) ? high : low;
    } else {
        middle = std::max(lanes, (middle + lanes / 2) / lanes * lanes);
        Box centres;
        for (const std::uint32_t i : which) centres.add(facets[i].centre);
        const Vec3 size = centres.size();
        const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0
                                 : size.y >= size.z                   ? 1
                                                                      : 2;
        std::nth_element(which.begin(), which.begin() + static_cast<std::ptrdiff_t>(middle),
                         which.end(), [&](std::uint32_t a, std::uint32_t b) {
                             const double x = facets[a].centre[axis], y = facets[b].centre[axis];
                             return x != y ? x < y : a < b;
                         });
    }
    build(which.first(middle), facets, rows, slack);
    nodes[at].right = static_cast<std::uint32_t>(nodes.size());
    build(which.subspan(middle), facets, rows, slack);
}

}  // namespace exitance
