// SPDX-License-Identifier: Apache-2.0
// From places on an image to rays into the scene: a pinhole.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "exitance/scene/scene.h"

namespace exitance {

class CameraRays {
  public:
    /// The vertical angle of `camera` fills the height. Throws Error(wrong_use) if the camera looks
    /// nowhere or its angle is not between 0 and 180 degrees.
    CameraRays(const Camera& camera, std::uint32_t width, std::uint32_t height);

    const Vec3& eye() const { return eye_; }
    /// Direction through image position (x, y) [pixels from the top left corner], scaled so that
    /// its component along the view axis is 1.
    Vec3 direction(double x, double y) const {
        return forward_ + right_ * ((x - centre_[0]) / focal_) - up_ * ((y - centre_[1]) / focal_);
    }
    /// Where a point is seen [pixels]; nothing behind the eye.
    std::optional<std::array<double, 2>> project(const Vec3& point) const;
    /// Distance on the image [pixels] from (x, y) to the line through two points of the scene.
    double distance_to_line(double x, double y, const Vec3& a, const Vec3& b) const;

  private:
    Vec3 eye_, right_, up_, forward_;
    std::array<double, 2> centre_;
    double focal_;  // [pixels]
};

}  // namespace exitance
