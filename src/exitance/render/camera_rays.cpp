// SPDX-License-Identifier: Apache-2.0
#include "exitance/render/camera_rays.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "exitance/run/error.h"
#include "exitance/scene/formats/limits.h"

namespace exitance {

CameraRays::CameraRays(const Camera& camera, std::uint32_t width, std::uint32_t height)
    : eye_(camera.eye), centre_{0.5 * width, 0.5 * height} {
    forward_ = normalized(camera.look_at - camera.eye);
    for (const Vec3& p : {camera.eye, camera.look_at})
        if (!(length(p) < limits::coordinate))
            throw Error(Fault::wrong_use, "camera '" + camera.name +
                                              "': a place beyond 1e9 m, expected one in the scene");
    if (!is_finite(forward_) || !is_finite(camera.eye) || length(forward_) < 0.5)
        throw Error(Fault::wrong_use,
                    "camera '" + camera.name + "': it looks at its own eye, expected a direction");
    if (!(camera.fov_y > 0 && camera.fov_y < 180))
        throw Error(Fault::wrong_use, "camera '" + camera.name + "': a field of view of " +
                                          std::to_string(camera.fov_y) +
                                          " degrees, expected more than 0 and less than 180");
    // Looking along its own up, any other axis will do.
    Vec3 side = cross(forward_, camera.up);
    if (!(length(side) > 1e-9 * length(camera.up)))
        side = cross(forward_, std::abs(forward_.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{0, 0, 1});
    right_ = normalized(side);
    up_ = cross(right_, forward_);
    focal_ = 0.5 * height / std::tan(0.5 * camera.fov_y * std::numbers::pi / 180);
}

std::optional<std::array<double, 2>> CameraRays::project(const Vec3& point) const {
    const Vec3 d = point - eye_;
    const double depth = dot(d, forward_);
    if (!(depth > 0)) return std::nullopt;
    return std::array{centre_[0] + focal_ * dot(d, right_) / depth,
                      centre_[1] - focal_ * dot(d, up_) / depth};
}

double CameraRays::distance_to_line(double x, double y, const Vec3& a, const Vec3& b) const {
    // Eye and line span a plane; its normal in camera axes holds the line's image coefficients.
    const Vec3 m = cross(a - eye_, b - eye_);
    const double scale = std::hypot(dot(m, right_), dot(m, up_));
    if (!(scale > 0)) return std::numeric_limits<double>::infinity();
    return focal_ * std::abs(dot(m, direction(x, y))) / scale;
}

}  // namespace exitance
