// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/facet_samples.h"

#include <algorithm>
#include <cmath>

#include "exitance/math/polygon.h"

namespace exitance {

FacetPlaces::FacetPlaces(const Facet& facet) : corners_(facet.outline), first_share_(1) {
    if (facet.count == 3) return;
    const double first = area(std::array{corners_[0], corners_[1], corners_[2]});
    const double second = area(std::array{corners_[0], corners_[2], corners_[3]});
    first_share_ = first / (first + second);
}

Vec3 FacetPlaces::operator()(UnitSquare u) const {
    const bool first = u[0] < first_share_;
    u[0] = first ? u[0] / first_share_ : (u[0] - first_share_) / (1 - first_share_);
    const auto w = uniform_triangle(u);
    return corners_[0] * w[0] + corners_[first ? 1 : 2] * w[1] + corners_[first ? 2 : 3] * w[2];
}

std::vector<FacetCell> facet_cells(const Facet& facet, std::size_t side) {
    std::vector<FacetCell> cells;
    cells.reserve(side * side);
    const auto& c = facet.outline;
    if (facet.count == 3) {
        const double step = 1.0 / static_cast<double>(side);
        const Vec3 u = (c[1] - c[0]) * step, v = (c[2] - c[0]) * step;
        const double part = facet.area * step * step;
        for (std::size_t j = 0; j < side; ++j)
            for (std::size_t i = 0; i + j < side; ++i) {
                const Vec3 corner = c[0] + u * static_cast<double>(i) + v * static_cast<double>(j);
                cells.push_back({corner + (u + v) / 3, part});
                if (i + j + 1 < side) cells.push_back({corner + (u + v) * (2.0 / 3), part});
            }
        return cells;
    }
    const double across = length(c[1] - c[0]) + length(c[2] - c[3]),
                 up = length(c[3] - c[0]) + length(c[2] - c[1]);
    const auto parts = [side](double stretch) {
        return side * static_cast<std::size_t>(std::lround(std::clamp(stretch, 1.0, 16.0)));
    };
    const std::size_t columns = parts(across / up), rows = parts(up / across);
    const auto at = [&](std::size_t i, std::size_t j) {
        const double s = static_cast<double>(i) / static_cast<double>(columns),
                     t = static_cast<double>(j) / static_cast<double>(rows);
        return (c[0] * (1 - s) + c[1] * s) * (1 - t) + (c[3] * (1 - s) + c[2] * s) * t;
    };
    for (std::size_t j = 0; j < rows; ++j)
        for (std::size_t i = 0; i < columns; ++i) {
            const std::array outline{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
            cells.push_back({centroid(outline), area(outline)});
        }
    return cells;
}

}  // namespace exitance
