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

/// Equal rectangles a × b facing each other at the distance c (Howell's catalogue C-11).
inline double facing_rectangles(double a, double b, double c) {
    const double X = a / c, Y = b / c, x = std::sqrt(1 + X * X), y = std::sqrt(1 + Y * Y);
    return 2 / (std::numbers::pi * X * Y) *
           (std::log(x * y / std::sqrt(1 + X * X + Y * Y)) + X * y * std::atan(X / y) +
            Y * x * std::atan(Y / x) - X * std::atan(X) - Y * std::atan(Y));
}

/// From a rectangle l × w to one l × h at right angles along the common edge l (Howell's C-14).
inline double rectangles_at_an_edge(double l, double w, double h) {
    const double W = w / l, H = h / l, w2 = W * W, h2 = H * H, s = w2 + h2;
    const double product = (1 + w2) * (1 + h2) / (1 + s) *
                           std::pow(w2 * (1 + s) / ((1 + w2) * s), w2) *
                           std::pow(h2 * (1 + s) / ((1 + h2) * s), h2);
    return (W * std::atan(1 / W) + H * std::atan(1 / H) -
            std::sqrt(s) * std::atan(1 / std::sqrt(s)) + 0.25 * std::log(product)) /
           (std::numbers::pi * W);
}

}  // namespace exitance::enclosures
