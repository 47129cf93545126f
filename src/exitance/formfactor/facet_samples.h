// SPDX-License-Identifier: Apache-2.0
// Places on a facet: spread evenly at random, or in a grid.
#pragma once

#include <vector>

#include "exitance/formfactor/enclosure.h"
#include "exitance/math/warp.h"

namespace exitance {

/// Maps the unit square onto a facet so that equal areas stay equal.
class FacetPlaces {
  public:
    explicit FacetPlaces(const Facet& facet);
    Vec3 operator()(UnitSquare u) const;

  private:
    std::array<Vec3, 4> corners_;
    double first_share_;  ///< of the triangle 0, 1, 2 in the area
};

/// A part of a facet: its middle and its area [m²].
struct FacetCell {
    Vec3 middle;
    double area;
};

/// About `side`² cells: a quadrilateral's grid of nearly square ones, a triangle's similar
/// triangles.
std::vector<FacetCell> facet_cells(const Facet& facet, std::size_t side);

}  // namespace exitance
