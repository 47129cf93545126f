// SPDX-License-Identifier: Apache-2.0
// A triangle as it is seen from a point: its solid angle, and directions spread evenly over it.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exitance/math/vector.h"
#include "exitance/math/warp.h"

namespace exitance {

/// Solid angle by Van Oosterom & Strackee 1983, directions by Arvo, "Stratified sampling of
/// spherical triangles", 1995.
class SphericalTriangle {
  public:
    /// Corners relative to the point; the point is not in the triangle's plane.
    SphericalTriangle(const Vec3& a, const Vec3& b, const Vec3& c)
        : a_(normalized(a)), b_(normalized(b)), c_(normalized(c)) {
        const double volume = std::abs(dot(a_, cross(b_, c_)));
        solid_angle_ = 2 * std::atan2(volume, 1 + dot(a_, b_) + dot(b_, c_) + dot(c_, a_));
        if (solid_angle_ < 0) solid_angle_ += 2 * std::numbers::pi;
        const Vec3 ab = normalized(cross(a_, b_)), ac = normalized(cross(a_, c_));
        cos_alpha_ = std::clamp(dot(ab, ac), -1.0, 1.0);
        sin_alpha_ = length(cross(ab, ac));
        alpha_ = std::atan2(sin_alpha_, cos_alpha_);
    }

    double solid_angle() const { return solid_angle_; }

    /// Unit vector; the first coordinate picks a triangle A B C' of that share of the area, the
    /// second a place on the arc from B to C'.
    Vec3 direction(const UnitSquare& u) const {
        const double part = u[0] * solid_angle_ - alpha_;
        const double s = std::sin(part), t = std::cos(part);
        const double p = t - cos_alpha_, q = s + sin_alpha_ * dot(a_, b_);
        const double below = (q * s + p * t) * sin_alpha_;
        const double along =
            below != 0 ? std::clamp(((q * t - p * s) * cos_alpha_ - q) / below, -1.0, 1.0) : 1.0;
        const Vec3 c = toward(a_, c_, along);
        return toward(b_, c, 1 - u[1] * (1 - dot(c, b_)));
    }

  private:
    /// The direction on the arc from `from` to `to` whose cosine with `from` is given.
    static Vec3 toward(const Vec3& from, const Vec3& to, double cosine) {
        const Vec3 across = to - from * dot(to, from);
        const double l = length(across);
        if (!(l > 0)) return from;
        return from * cosine + across * (std::sqrt(std::max(0.0, 1 - cosine * cosine)) / l);
    }

    Vec3 a_, b_, c_;
    double solid_angle_, cos_alpha_, sin_alpha_, alpha_;
};

}  // namespace exitance
