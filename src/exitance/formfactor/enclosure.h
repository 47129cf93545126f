// SPDX-License-Identifier: Apache-2.0
// What form factors are asked between: facets that see each other, added up into rows.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "exitance/math/vector.h"

namespace exitance {

/// A planar convex polygon. Light leaves and reaches its front; it blocks light both ways.
struct Facet {
    static constexpr std::uint32_t only_blocks = 0xffffffffU;

    std::array<Vec3, 4> outline{};  ///< counter-clockwise seen from the front [m]
    std::uint32_t count = 4;        ///< corners
    std::uint32_t row = only_blocks;
    Vec3 normal;      ///< unit
    double area = 0;  ///< [m²]

    std::span<const Vec3> corners() const { return {outline.data(), count}; }
};

/// What one row and column of the matrix stands for: a polygon, patch, element or surface.
struct ExchangeSurface {
    std::string name;
    double area = 0;        ///< of its facets [m²]
    double emissivity = 1;  ///< 0 … 1
};

/// A two-sided polygon is two facets, back to back.
struct Enclosure {
    std::vector<Facet> facets;
    std::vector<ExchangeSurface> surfaces;  ///< one per row
};

}  // namespace exitance
