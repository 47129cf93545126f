// SPDX-License-Identifier: Apache-2.0
// Form factors between rectangles in closed form (Howell's catalogue, C-11, C-13, C-14, C-15).
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "exitance/formfactor/enclosure.h"
#include "exitance/math/polygon.h"

namespace exitance::view_factors {

using Quad = std::array<Vec3, 4>;

/// [x0, x1] × [y0, y1] at height z, facing up or down.
inline Quad level(double x0, double x1, double y0, double y1, double z, bool up) {
    if (up) return {{{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}}};
    return {{{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}}};
}

/// Howell C-11: equal parallel rectangles a × b at distance c.
inline double parallel(double a, double b, double c) {
    const double X = a / c, Y = b / c, x = std::sqrt(1 + X * X), y = std::sqrt(1 + Y * Y);
    return 2 / (std::numbers::pi * X * Y) *
           (std::log(x * y / std::sqrt(1 + X * X + Y * Y)) + X * y * std::atan(X / y) +
            Y * x * std::atan(Y / x) - X * std::atan(X) - Y * std::atan(Y));
}

/// Howell C-14: w × l and h × l at right angles along a common edge of length l; from the first.
inline double perpendicular(double l, double w, double h) {
    const double W = w / l, H = h / l, W2 = W * W, H2 = H * H, s = std::sqrt(H2 + W2);
    const double logs = std::log((1 + W2) * (1 + H2) / (1 + W2 + H2)) +
                        W2 * std::log(W2 * (1 + W2 + H2) / ((1 + W2) * (W2 + H2))) +
                        H2 * std::log(H2 * (1 + H2 + W2) / ((1 + H2) * (H2 + W2)));
    return (W * std::atan(1 / W) + H * std::atan(1 / H) - s * std::atan(1 / s) + 0.25 * logs) /
           (std::numbers::pi * W);
}

/// Howell C-13: from [x0, x1] × [y0, y1] at height 0 to [u0, u1] × [v0, v1] at height z.
inline double offset_parallel(std::array<double, 2> x, std::array<double, 2> y,
                              std::array<double, 2> u, std::array<double, 2> v, double z) {
    const auto G = [z](double a, double b) {  // a, b: differences of coordinates
        const double p = std::sqrt(a * a + z * z), q = std::sqrt(b * b + z * z);
        return (b * p * std::atan(b / p) + a * q * std::atan(a / q) -
                0.5 * z * z * std::log(a * a + b * b + z * z)) /
               (2 * std::numbers::pi);
    };
    double sum = 0;
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
            for (int k = 0; k < 2; ++k)
                for (int l = 0; l < 2; ++l) {
                    const auto at = [](const std::array<double, 2>& of, int which) {
                        return of[static_cast<std::size_t>(which)];
                    };
                    sum += ((i + j + k + l) % 2 ? -1 : 1) *
                           G(at(x, i) - at(u, j), at(y, k) - at(v, l));
                }
    return sum / ((x[1] - x[0]) * (y[1] - y[0]));
}

inline void add_facet(Enclosure& enclosure, std::span<const Vec3> corners,
                      bool only_blocks = false) {
    Facet facet;
    facet.count = static_cast<std::uint32_t>(corners.size());
    std::copy(corners.begin(), corners.end(), facet.outline.begin());
    facet.normal = unit_normal(corners);
    facet.area = area(corners);
    if (!only_blocks) {
        facet.row = static_cast<std::uint32_t>(enclosure.surfaces.size());
        enclosure.surfaces.push_back({std::to_string(facet.row + 1), facet.area, 1});
    }
    enclosure.facets.push_back(facet);
}

/// The six faces of the box between two corners, n × n facets each, seen from inside or outside.
inline void add_box(Enclosure& enclosure, const Vec3& low, const Vec3& high, std::size_t n,
                    bool inside) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const bool top : {false, true}) {
            Vec3 u, v, from = low;
            const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
            u[a] = (high[a] - low[a]) / double(n);
            v[b] = (high[b] - low[b]) / double(n);
            if (top) from[axis] = high[axis];
            if (top == inside) std::swap(u, v);
            for (std::size_t j = 0; j < n; ++j)
                for (std::size_t i = 0; i < n; ++i) {
                    const Vec3 at = from + u * double(i) + v * double(j);
                    add_facet(enclosure, Quad{at, at + u, at + u + v, at + v});
                }
        }
}

}  // namespace exitance::view_factors
