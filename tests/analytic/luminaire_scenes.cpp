// SPDX-License-Identifier: Apache-2.0
#include "analytic/luminaire_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "analytic/configuration_factors.h"
#include "scene/lamps.h"
#include "scene/small_scenes.h"

namespace exitance::analytic {

namespace {

using testing::cosine_photometry;
using testing::hanging;

Case lamp_over_a_floor() {
    Case c;
    c.name = "cosine_lamp";
    testing::add_square(c.scene, testing::add_surface(c.scene, "floor", 0.5), -3, -3, 0, 6);
    c.scene.luminaires.push_back(hanging(cosine_photometry(1000), {0, 0, 3}));
    for (const auto& [x, y] :
         std::array<std::array<double, 2>, 4>{{{0, 0}, {1.5, 1.5}, {-2.2, 0.4}, {2.9, -2.9}}}) {
        const double square = x * x + y * y + 9;
        c.probes.push_back({{x, y, 0}, {0, 0, 1}, Spectrum(3, 9000 / (square * square))});
    }
    c.why =
        "I = 1000 cd cosθ 3 m up: E = I cosθ / r²; 111.111 lx below, 49.383 lx 1.5 m aside; "
        "1 % for interpolation";
    return c;
}

Case point_over_a_square() {
    // From (0, 0, 2) the square [-0.4,0.4]² at z = 1 hides [-0.8,0.8]² of the floor.
    Case c;
    c.name = "shadow_of_a_point";
    testing::add_square(c.scene, testing::add_surface(c.scene, "floor", 0.5), -3, -3, 0, 6);
    const auto square = testing::add_surface(c.scene, "square", 0);
    c.scene.materials[c.scene.surfaces[square].material].two_sided = true;
    testing::add_square(c.scene, square, -0.4, -0.4, 1, 0.8);
    c.scene.luminaires.push_back(hanging(cosine_photometry(500), {0, 0, 2}));
    for (const auto& [x, y] : std::array<std::array<double, 2>, 6>{
             {{0, 0}, {0.7, 0.7}, {0.9, 0}, {0.1, -0.92}, {-1.5, 0.3}, {2, 2}}}) {
        const bool hidden = std::max(std::abs(x), std::abs(y)) < 0.8;
        const double r2 = x * x + y * y + 4;
        c.probes.push_back({{x, y, 0}, {0, 0, 1}, Spectrum(3, hidden ? 0.0 : 500 * 4 / (r2 * r2))});
    }
    c.imbalance = 3e-3;
    c.even_element_size = 0.11;  // about the way from the edge to the nearest probe
    c.why =
        "a point's shadow has a sharp edge, 0.1 m from the nearest probe; 1 % for interpolation";
    return c;
}

Case panel_over_a_square() {
    // The occluded square of scenes.cpp with the lamp as an opening of intensity M A cosθ / π.
    Case c;
    c.name = "shadow_of_a_panel";
    const auto square = testing::add_surface(c.scene, "square", 0);
    c.scene.materials[c.scene.surfaces[square].material].two_sided = true;
    testing::add_square(c.scene, square, -0.4, -0.4, 1, 0.8);
    testing::add_square(c.scene, testing::add_surface(c.scene, "floor", 0.5), -3, -3, 0, 6);
    const auto opening = testing::opening(LuminousOpening::Shape::box, {2, 2, 0});
    c.scene.luminaires.push_back(
        hanging(cosine_photometry(100 * 4 / std::numbers::pi, opening), {0, 0, 2}));
    for (const auto& [x, y] : std::array<std::array<double, 2>, 7>{
             {{0, 0}, {0.3, 0.1}, {0.7, 0}, {1.2, 0.9}, {1.7, 0.2}, {2.4, 2.4}, {-1, 0.5}}}) {
        const double x0 = std::clamp(-0.8 - x, -1.0, 1.0), x1 = std::clamp(0.8 - x, -1.0, 1.0);
        const double y0 = std::clamp(-0.8 - y, -1.0, 1.0), y1 = std::clamp(0.8 - y, -1.0, 1.0);
        const double whole = parallel_rectangle(-1 - x, 1 - x, -1 - y, 1 - y, 2);
        const double hidden = parallel_rectangle(x0 - x, x1 - x, y0 - y, y1 - y, 2);
        c.probes.push_back({{x, y, 0}, {0, 0, 1}, Spectrum(3, 100 * (whole - hidden))});
    }
    c.tolerance = 0.02;
    c.imbalance = 3e-3;
    c.why =
        "an opening that sends I cosθ is a lamp of even exitance, lamp minus the part that the "
        "square hides, both Howell B-3; 2 % for interpolation across the penumbra";
    return c;
}

}  // namespace

std::vector<Case> luminaire_cases() {
    return {lamp_over_a_floor(), point_over_a_square(), panel_over_a_square()};
}

}  // namespace exitance::analytic
