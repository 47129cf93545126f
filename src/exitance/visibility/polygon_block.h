// SPDX-License-Identifier: Apache-2.0
// Sixteen polygons side by side, and what one blocker does between them and a seventeenth.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/visibility/blocker.h"

namespace exitance {

/// Convex polygons of three or four corners (a triangle repeats its last). Lanes beyond `count`
/// repeat the first. Coordinates in a frame where the scene has about unit size.
struct alignas(64) PolygonBlock {
    static constexpr std::size_t capacity = 16;
    using Lanes = std::array<float, capacity>;

    std::array<Lanes, 4> x, y, z;
    Lanes nx, ny, nz, offset;
    std::uint32_t count = 0;

    void set(std::size_t lane, std::span<const Vec3> corners, const Plane& plane);
};

/// Bit per polygon of a block.
using LaneMask = std::uint32_t;

/// Heights of a block's corners over the planes of a blocker, and of the blocker's corners over the
/// planes of the block.
struct BlockHeights {
    std::vector<float> corner;   ///< [plane][corner][lane]
    std::vector<float> lowest;   ///< [plane][lane]
    std::vector<float> highest;  ///< [plane][lane]
    LaneMask before = 0;         ///< the whole blocker is before the polygon's plane
    LaneMask beyond = 0;         ///< the whole blocker is behind it
};

void measure(const Blocker& blocker, const PolygonBlock& block, float slack, BlockHeights& heights);

/// What a blocker does between one polygon and each of a block: stands apart, hides all of the one
/// from all of the other, or what is in neither mask: perhaps hides a part.
struct Standing {
    LaneMask apart = 0, hides = 0;
};

/// `corners`: of the one polygon, four. Convexity makes it exact: a product of heights that has one
/// sign for all pairs of corners has it for all pairs of points.
Standing stand_between(const Blocker& blocker, const BlockHeights& heights,
                       std::span<const Vec3, 4> corners, float slack);

/// What is done with one pair after all: the rims of the blocker that can be seen from `from`
/// before `to`, or that it is apart or hides.
enum class Stand : std::uint8_t { apart, hides, between };
Stand find_rims(const Blocker& blocker, std::span<const Vec3> from, std::span<const Vec3> to,
                double slack, std::vector<std::uint32_t>& rims);

}  // namespace exitance
