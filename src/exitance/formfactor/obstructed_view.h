// SPDX-License-Identifier: Apache-2.0
// How much of a polygon sixteen points see past convex obstacles, exactly for each point: Lambert's
// formula over the outline of what is visible. The outline consists of the target's sides outside
// all obstacles and of the obstacles' rims inside the target and outside the other obstacles, so
// intervals on straight lines are all that has to be found.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/math/small_polygon.h"
#include "exitance/visibility/blocker.h"

namespace exitance {

/// Points of one plane with the plane's normal, relative to the target's frame.
struct alignas(64) Viewpoints {
    static constexpr std::size_t capacity = 16;
    std::array<float, capacity> x, y, z;

    void set(std::size_t k, const Vec3f& p) { x[k] = p.x, y[k] = p.y, z[k] = p.z; }
};

/// Form factors from each point to the target: with nothing between, and past the obstacles.
struct alignas(64) ViewFactors {
    std::array<float, Viewpoints::capacity> free, seen;
};

/// An obstacle with those of its edges that may be seen before the target.
struct Obstacle {
    const Blocker* blocker = nullptr;
    std::span<const std::uint32_t> rims;  ///< into blocker->edges
};

/// A target and what stands before it, laid out for the inner loop: float, in a frame of its own.
class ObstructedTarget {
  public:
    /// Positions are taken relative to `origin` and times `scale`. `target` is convex, before the
    /// plane of the viewpoints, whose normal is `receiver`; obstacles are before the target's
    /// plane.
    void set(const SmallPolygon& target, const Plane& plane, const Vec3& receiver,
             std::span<const Obstacle> obstacles, const Vec3& origin, double scale);

    Vec3f local(const Vec3& p) const { return Vec3f((p - origin_) * scale_); }

    struct Line {
        Vec3f from, along;  ///< unit
        float length;
    };
    struct FloatPlane {
        Vec3f normal;
        float offset;
    };
    struct Side {
        Line line;
        FloatPlane outward;  ///< across the target's plane
    };
    struct Rim {
        Line line;
        FloatPlane left, right;
        std::uint32_t obstacle;
        bool sheet;
    };
    /// Heights of a point over both planes of a rim.
    struct Heights {
        float left, right;
    };
    enum class Alike : std::int8_t {
        no,
        same_way,
        opposite
    };  ///< of two lines: whether they are one

    FloatPlane plane;
    Vec3f receiver;
    std::vector<Side> sides;
    std::vector<Rim> rims;
    std::vector<std::uint32_t> first_rim;              ///< of each obstacle, and the end
    std::vector<Heights> corner_over_rim;              ///< [rim][corner of the target]
    std::vector<Alike> side_on_rim;                    ///< [rim][side]
    std::vector<std::array<float, 2>> rim_over_plane;  ///< [rim], both ends
    std::vector<std::array<float, 2>> rim_over_side;   ///< [rim][side], both ends
    std::vector<std::array<Heights, 2>> rim_over_rim;  ///< [rim][other], both ends
    std::vector<Alike> rim_on_rim;                     ///< [rim][other]
    mutable std::vector<float> scratch;

  private:
    Vec3 origin_;
    double scale_ = 1;
};

void view(const ObstructedTarget& target, const Viewpoints& points, ViewFactors& factors);

}  // namespace exitance
