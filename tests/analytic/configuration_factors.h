// SPDX-License-Identifier: Apache-2.0
// Textbook form factors from a point to a rectangle, written down separately from the project's
// own kernels so that they can judge them.
#pragma once

#include <cmath>
#include <numbers>

namespace exitance::analytic {

/// From a point to a parallel rectangle a × b at the distance c, one corner straight above the
/// point (Howell's catalogue B-3).
inline double parallel_rectangle(double a, double b, double c) {
    const double A = std::hypot(a, c), B = std::hypot(b, c);
    return (a / A * std::atan(b / A) + b / B * std::atan(a / B)) / (2 * std::numbers::pi);
}

/// From a point to the parallel rectangle [x0, x1] × [y0, y1] (relative to the point's foot) at the
/// distance c.
inline double parallel_rectangle(double x0, double x1, double y0, double y1, double c) {
    const auto corner = [c](double x, double y) {
        const double F = parallel_rectangle(std::abs(x), std::abs(y), c);
        return x * y < 0 ? -F : F;
    };
    return corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0);
}

/// From a point of a floor to a wall at the distance c, of height a, which reaches from the foot
/// of the perpendicular to b on one side (Howell's catalogue B-4).
inline double perpendicular_rectangle(double a, double b, double c) {
    const double d = std::hypot(a, c);
    return (std::atan(b / c) - c / d * std::atan(b / d)) / (2 * std::numbers::pi);
}

}  // namespace exitance::analytic
