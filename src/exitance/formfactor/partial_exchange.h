// SPDX-License-Identifier: Apache-2.0
// Exchange area of two polygons that partly see each other: what of the one is visible is found
// exactly from points of the other, and the points are put where it varies.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/formfactor/obstructed_view.h"

namespace exitance {

struct PartialExchange {
    double seen = 0, hidden = 0;  ///< by the same points; their sum is what is free
    bool by_hidden = false;       ///< `hidden` is the more accurate of the two
};

/// Keeps its working memory from pair to pair; one for each thread.
class PartialExchanger {
  public:
    /// Points lie on `from`, which is wholly before the plane of `to`, and the other way round;
    /// obstacles are before the plane of `to`. `tolerance`: of the exchange area.
    PartialExchange operator()(const SmallPolygon& from, const Plane& from_plane,
                               const SmallPolygon& to, const Plane& to_plane,
                               std::span<const Obstacle> obstacles, double tolerance);

    /// With nothing between, by sixteen points and in float: for polygons that are farther apart
    /// than they are wide, to a few millionths.
    double free(std::span<const Vec3> from, const Plane& from_plane, std::span<const Vec3> to,
                const Plane& to_plane);

    std::uint64_t viewpoints = 0;  ///< looked from so far

  private:
    /// A corner of the viewpoints' polygon, as the image of a unit square.
    struct Root {
        std::array<Vec3, 4> corners;
        std::array<double, 3> jacobian;  ///< 1, s, t

        Root(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& normal);
        /// The image of (s, t), and how much larger areas are there.
        Vec3 at(double s, double t) const;
        double density(double s, double t) const {
            return jacobian[0] + jacobian[1] * s + jacobian[2] * t;
        }
    };
    /// What is seen and what is hidden, or differences of both.
    struct Parts {
        double seen = 0, hidden = 0;
    };
    struct Cell {
        std::uint32_t root = 0;
        double s = 0, t = 0, size = 1;
        bool forced = false;  ///< large against its distance from what it looks past
        Parts found;
        Parts change;                   ///< from the parent's coarser rule
        Parts unevenness;               ///< of the sums over rows, columns and the chequer
        std::array<Parts, 4> quadrant;  ///< by that rule
    };
    void look(Cell& cell);
    void split(std::size_t which);
    bool is_large(const Cell& cell) const;
    Parts errors() const;

    std::vector<Box> near_;  ///< target and obstacles
    ObstructedTarget target_;
    std::vector<Root> roots_;
    std::vector<Cell> cells_;
};

}  // namespace exitance
