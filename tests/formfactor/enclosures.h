// SPDX-License-Identifier: Apache-2.0
// Small enclosures for tests, and textbook form factors between areas, written down separately from
// the project's kernels.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "exitance/formfactor/enclosure.h"
#include "exitance/formfactor/method.h"
#include "exitance/math/polygon.h"

namespace exitance::enclosures {

/// Adds a facet of row `row`; a row that is new gets a surface.
inline void add(Enclosure& enclosure, const std::vector<Vec3>& outline, std::uint32_t row) {
    Facet facet;
    facet.count = static_cast<std::uint32_t>(outline.size());
    for (std::size_t i = 0; i < 4; ++i) facet.outline[i] = outline[std::min(i, outline.size() - 1)];
    facet.normal = unit_normal(outline);
    facet.area = area(outline);
    facet.row = row;
    if (row != Facet::only_blocks) {
        while (enclosure.surfaces.size() <= row)
            enclosure.surfaces.push_back(
                {"s" + std::to_string(enclosure.surfaces.size() + 1), 0, 1});
        enclosure.surfaces[row].area += facet.area;
    }
    enclosure.facets.push_back(facet);
}

/// A rectangle from `corner` along `u` and `v`, facing u × v, in n × n facets; each its own row
/// from `row` on, or all in it.
inline void add_rectangle(Enclosure& enclosure, const Vec3& corner, const Vec3& u, const Vec3& v,
                          std::uint32_t row, std::size_t n = 1, bool one_row = true) {
    const double step = 1.0 / static_cast<double>(n);
    const auto at = [&](std::size_t i, std::size_t j) {
        return corner + u * (static_cast<double>(i) * step) + v * (static_cast<double>(j) * step);
    };
    for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = 0; i < n; ++i)
            add(enclosure, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)},
                one_row ? row : row + static_cast<std::uint32_t>(j * n + i));
}

/// The six faces of an axis-aligned box, seen from inside or from outside; rows from `row` on.
inline void add_box(Enclosure& enclosure, const Vec3& low, double side, bool inside,
                    std::uint32_t row, std::size_t n = 1, bool one_row_a_face = true) {
    const Vec3 x{side, 0, 0}, y{0, side, 0}, z{0, 0, side};
    const std::array<std::array<Vec3, 3>, 6> faces{
        {{low, x, y}, {low + z, y, x}, {low, y, z}, {low + x, z, y}, {low, z, x}, {low + y, x, z}}};
    const auto rows = static_cast<std::uint32_t>(one_row_a_face ? 1 : n * n);
    for (std::uint32_t f = 0; f < 6; ++f) {
        const auto& [corner, u, v] = faces[f];
        add_rectangle(enclosure, corner, inside ? u : v, inside ? v : u, row + f * rows, n,
                      one_row_a_face);
    }
}

inline FormFactorMatrix compute(const Enclosure& enclosure, const std::string& method,
                                const MethodOptions& options) {
    MethodCounters counters;
    const Observer nobody;
    return find_form_factor_method(method).compute({enclosure, options, nobody, nullptr, counters});
}

/// All of F with its zeros.
inline std::vector<std::vector<double>> dense(const FormFactorMatrix& F) {
    std::vector<std::vector<double>> out(F.rows(), std::vector<double>(F.rows()));
    F.for_rows([&](std::size_t i, std::span<const FormFactorMatrix::Entry> entries) {
        for (const auto& e : entries) out[i][e.column] = static_cast<double>(e.value);
    });
    return out;
}

}  // namespace exitance::enclosures
