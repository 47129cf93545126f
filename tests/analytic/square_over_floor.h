// SPDX-License-Identifier: Apache-2.0
// A floor that reflects half, [-3, 3]² at z = 0, and a black square, [-0.4, 0.4]² at z = 1, under
// something that shines down: what both sides of the square get.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "analytic/configuration_factors.h"
#include "analytic/scenes.h"
#include "scene/small_scenes.h"

namespace exitance::analytic {

inline void add_black_square(Scene& scene) {
    const auto square = testing::add_surface(scene, "square", 0);
    scene.materials[scene.surfaces[square].material].two_sided = true;
    testing::add_square(scene, square, -0.4, -0.4, 1, 0.8);
}

using PlaneLight = std::function<double(double x, double y)>;

/// From the light of the floor and of the square's upper side, those of all three sides. The
/// underside sees the floor: ρ H h² / (π r⁴) summed over its cells, which shadow lines 0.8 m from
/// the middle do not cut.
inline ExactLight around_the_square(const PlaneLight& floor, const PlaneLight& square) {
    constexpr int cells = 150;
    constexpr double side = 6.0 / cells, rho = 0.5;
    const auto middle = [](int i) { return -3 + (i + 0.5) * side; };
    const auto lit = std::make_shared<std::vector<double>>();
    for (int j = 0; j < cells; ++j)
        for (int i = 0; i < cells; ++i) lit->push_back(floor(middle(i), middle(j)));
    return [=](const Vec3& at, const Vec3& normal) -> std::optional<Spectrum> {
        if (at.z < 0.5) return Spectrum(3, floor(at.x, at.y));
        if (normal.z > 0) return Spectrum(3, square(at.x, at.y));
        double sum = 0;
        for (int j = 0; j < cells; ++j)
            for (int i = 0; i < cells; ++i) {
                const double dx = middle(i) - at.x, dy = middle(j) - at.y;
                const double r2 = dx * dx + dy * dy + 1;
                sum += (*lit)[static_cast<std::size_t>(j * cells + i)] / (r2 * r2);
            }
        return Spectrum(3, rho * sum * side * side / std::numbers::pi);
    };
}

/// The same under an evenly bright lamp, [-1, 1]² at z = 2, exitance 100. Seen from (x, y, 0) the
/// square covers [-0.8 - x, 0.8 - x] × [-0.8 - y, 0.8 - y] of the lamp's plane: the floor gets the
/// lamp less the part that is hidden, both Howell B-3.
inline ExactLight square_under_a_panel() {
    const auto floor = [](double x, double y) {
        const double x0 = std::clamp(-0.8 - x, -1.0, 1.0), x1 = std::clamp(0.8 - x, -1.0, 1.0);
        const double y0 = std::clamp(-0.8 - y, -1.0, 1.0), y1 = std::clamp(0.8 - y, -1.0, 1.0);
        const double whole = parallel_rectangle(-1 - x, 1 - x, -1 - y, 1 - y, 2);
        const double hidden = parallel_rectangle(x0 - x, x1 - x, y0 - y, y1 - y, 2);
        return 100 * (whole - hidden);
    };
    const auto square = [](double x, double y) {
        return 100 * parallel_rectangle(-1 - x, 1 - x, -1 - y, 1 - y, 1);
    };
    return around_the_square(floor, square);
}

}  // namespace exitance::analytic
