// SPDX-License-Identifier: Apache-2.0
#include "analytic/luminaire_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "analytic/square_over_floor.h"
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
    c.exact = [](const Vec3& at, const Vec3&) {
        const double r2 = at.x * at.x + at.y * at.y + 9;
        return Spectrum(3, 9000 / (r2 * r2));
    };
    for (const auto& [x, y] :
         std::array<std::array<double, 2>, 4>{{{0, 0}, {1.5, 1.5}, {-2.2, 0.4}, {2.9, -2.9}}})
        c.add_probe({x, y, 0}, {0, 0, 1});
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
    add_black_square(c.scene);
    c.scene.luminaires.push_back(hanging(cosine_photometry(500), {0, 0, 2}));
    const auto from = [](double height, double x, double y) {
        const double r2 = x * x + y * y + height * height;
        return 500 * height * height / (r2 * r2);
    };
    const auto floor = [from](double x, double y) {
        const bool hidden = std::max(std::abs(x), std::abs(y)) < 0.8;
        return hidden ? 0.0 : from(2, x, y);
    };
    c.exact = around_the_square(floor, [from](double x, double y) { return from(1, x, y); });
    for (const auto& [x, y] : std::array<std::array<double, 2>, 6>{
             {{0, 0}, {0.7, 0.7}, {0.9, 0}, {0.1, -0.92}, {-1.5, 0.3}, {2, 2}}})
        c.add_probe({x, y, 0}, {0, 0, 1});
    c.imbalance = 3e-3;
    c.even_element_size = 0.11;  // about the way from the edge to the nearest probe
    c.why =
        "a point's shadow has a sharp edge, 0.1 m from the nearest probe; 1 % for interpolation";
    return c;
}

Case panel_over_a_square() {
    // The occluded square of plate_scenes.cpp, its lamp an opening of intensity M A cosθ / π.
    Case c;
    c.name = "shadow_of_a_panel";
    add_black_square(c.scene);
    testing::add_square(c.scene, testing::add_surface(c.scene, "floor", 0.5), -3, -3, 0, 6);
    const auto opening = testing::opening(LuminousOpening::Shape::box, {2, 2, 0});
    c.scene.luminaires.push_back(
        hanging(cosine_photometry(100 * 4 / std::numbers::pi, opening), {0, 0, 2}));
    c.exact = square_under_a_panel();
    for (const auto& [x, y] : std::array<std::array<double, 2>, 7>{
             {{0, 0}, {0.3, 0.1}, {0.7, 0}, {1.2, 0.9}, {1.7, 0.2}, {2.4, 2.4}, {-1, 0.5}}})
        c.add_probe({x, y, 0}, {0, 0, 1});
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
