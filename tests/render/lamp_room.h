// SPDX-License-Identifier: Apache-2.0
// A room under a square lamp, lit by hand: direct light by the exact factor (nothing hides the
// lamp from its walls), reflected light as a constant.
#pragma once

#include "exitance/formfactor/point_polygon.h"
#include "solution/hand_made.h"

namespace exitance::hand_made {

/// 2 × 2 × 2 m around the origin, open at z = +1; red on the left, green on the right; lamp in
/// group 0, a constant glow of the walls' irradiance in group 1; two blocks' tops as tables.
inline Solution lamp_room(std::uint32_t cells = 16) {
    Solution s = empty_solution({{"lamp", 1.0}, {"glow", 1.0}});
    s.quantity = Quantity::photometric;
    const auto white = add_material(s, "white", {0.73, 0.71, 0.68});
    const auto red = add_material(s, "red", {0.63, 0.065, 0.05});
    const auto green = add_material(s, "green", {0.14, 0.45, 0.091});
    const auto lamp = add_material(s, "lamp", {0.1, 0.1, 0.1}, {5000, 4200, 2800});
    const std::array<Vec3, 4> corners{Vec3{-0.35, 0.99, -0.35}, Vec3{0.35, 0.99, -0.35},
                                      Vec3{0.35, 0.99, 0.35}, Vec3{-0.35, 0.99, 0.35}};
    const Light light = [&](const Vec3& p, const Vec3& n) {
        const auto F = static_cast<float>(point_polygon_factor(p, n, corners));
        return std::vector<float>{5000 * F, 4200 * F, 2800 * F, 60, 65, 80};
    };
    const Vec3 x{2, 0, 0}, y{0, 2, 0}, z{0, 0, 2}, low{-1, -1, -1};
    add_sheet(s, "floor", white, 0, low, z, x, cells, cells, light);
    add_sheet(s, "ceiling", white, 0, low + y, x, z, cells, cells, light);
    add_sheet(s, "left", red, 0, low, y, z, cells, cells, light);
    add_sheet(s, "right", green, 0, low + x, z, y, cells, cells, light);
    add_sheet(s, "back", white, 0, low, x, y, cells, cells, light);
    add_sheet(s, "lamp", lamp, 0, corners[0], {0.7, 0, 0}, {0, 0, 0.7}, 2, 2, uniform(s, 0));
    add_sheet(s, "table", white, 0, {-0.7, -0.5, -0.6}, {0.15, 0, 0.6}, {0.6, 0, -0.15}, cells / 4,
              cells / 4, light);
    Camera camera;
    camera.name = "front";
    camera.eye = {0, 0, 3.6};
    camera.look_at = {0, 0, 0};
    camera.fov_y = 42;
    camera.aspect = 1;
    s.cameras.push_back(camera);
    return s;
}

}  // namespace exitance::hand_made
