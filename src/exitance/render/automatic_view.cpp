// SPDX-License-Identifier: Apache-2.0
#include "exitance/render/automatic_view.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "exitance/math/box.h"
#include "exitance/math/frame.h"
#include "exitance/run/random.h"

namespace exitance {

Camera automatic_view(const Surfaces& surfaces, const Vec3& up) {
    Box box;
    for (const Vec3f& p : surfaces.solution().positions) box.add(Vec3(p));
    const Vec3 middle = box.empty() ? Vec3{} : box.centre();
    const double diagonal = std::max(surfaces.diagonal(), 1e-6);
    constexpr double far = std::numeric_limits<double>::infinity();
    Camera camera;
    camera.name = "automatic";
    camera.up = up;

    // Inside a room most directions meet the front of something.
    int met = 0;
    constexpr int directions = 128;
    for (std::uint32_t i = 0; i < directions; ++i) {
        const auto [u, v] = low_discrepancy(0, i);
        const double z = 1 - 2 * u, r = std::sqrt(1 - z * z), phi = 2 * std::numbers::pi * v;
        const Vec3 d{r * std::cos(phi), r * std::sin(phi), z};
        if (surfaces.caster().closest(middle, d, 0, far)) ++met;
    }
    const Frame frame(normalized(up));
    // How far the walls are on the level of the middle.
    double longest = 0;
    Vec3 back = frame.tangent;
    for (int i = 0; i < 64; ++i) {
        const double phi = 2 * std::numbers::pi * i / 64;
        const Vec3 d = frame.tangent * std::cos(phi) + frame.bitangent * std::sin(phi);
        const auto hit = surfaces.caster().closest(middle, d, 0, far);
        const double free = hit ? double(hit->distance) : 0.0;
        if (free > longest) longest = free, back = d;
    }
    if (met > 0.6 * directions && longest > 0.05 * diagonal) {
        // Back against the farthest wall, a little to the side of straight across.
        camera.eye = middle + back * (0.92 * longest);
        camera.look_at = middle - back * (0.25 * longest) - frame.normal * (0.05 * longest);
        camera.fov_y = 65;
    } else {
        camera.fov_y = 40;
        const double distance =
            0.52 * diagonal / std::sin(0.5 * camera.fov_y * std::numbers::pi / 180);
        const Vec3 towards =
            normalized(frame.tangent * 0.45 + frame.bitangent * 0.75 + frame.normal * 0.45);
        camera.eye = middle + towards * distance;
        camera.look_at = middle;
    }
    return camera;
}

}  // namespace exitance
