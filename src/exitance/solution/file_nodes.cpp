// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/file_nodes.h"

#include <nlohmann/json.hpp>
#include <numbers>

#include "exitance/math/box.h"

namespace exitance::solution_file {

using nlohmann::json;

namespace {

// The quaternion that turns `up` to +y; nothing if it is there.
std::optional<std::array<double, 4>> upright(const Vec3& up) {
    const Vec3 from = normalized(up), axis = cross(from, {0, 1, 0});
    if (from.y > 1 - 1e-12) return std::nullopt;
    if (from.y < -1 + 1e-12) return std::array{1.0, 0.0, 0.0, 0.0};
    const double w = 1 + from.y, norm = std::sqrt(w * w + dot(axis, axis));
    return std::array{axis.x / norm, axis.y / norm, axis.z / norm, w / norm};
}

}  // namespace

void describe_cameras(const Solution& solution, json& gltf) {
    Box box;
    for (const Vec3f& p : solution.positions) box.add(Vec3(p));
    for (const Camera& camera : solution.cameras) {
        const Vec3 back = normalized(camera.eye - camera.look_at);
        const Vec3 right = normalized(cross(camera.up, back));
        const Vec3 up = cross(back, right);
        if (!(length(right) > 0) || !(camera.fov_y > 0 && camera.fov_y < 180)) continue;
        json perspective{{"yfov", camera.fov_y * std::numbers::pi / 180},
                         {"znear", camera.near.value_or(std::max(1e-3 * box.diagonal(), 1e-6))}};
        if (camera.aspect) perspective["aspectRatio"] = *camera.aspect;
        if (camera.far) perspective["zfar"] = *camera.far;
        gltf["nodes"].push_back(
            {{"name", camera.name},
             {"camera", gltf["cameras"].size()},
             {"matrix",
              {right.x, right.y, right.z, 0, up.x, up.y, up.z, 0, back.x, back.y, back.z, 0,
               camera.eye.x, camera.eye.y, camera.eye.z, 1}}});
        gltf["cameras"].push_back(
            {{"name", camera.name}, {"type", "perspective"}, {"perspective", perspective}});
    }
}

void stand_upright(const Vec3& up, json& gltf) {
    if (!gltf.contains("nodes")) return;
    json all = json::array();
    for (std::size_t i = 0; i < gltf["nodes"].size(); ++i) all.push_back(i);
    if (const auto rotation = upright(up)) {
        const std::size_t root = gltf["nodes"].size();
        gltf["nodes"].push_back({{"name", "upright"}, {"rotation", *rotation}, {"children", all}});
        all = {root};
    }
    gltf["scenes"] = {{{"nodes", all}}};
    gltf["scene"] = 0;
}

}  // namespace exitance::solution_file
