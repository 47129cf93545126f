// SPDX-License-Identifier: Apache-2.0
// The two ends of a transfer of light, as the hot loops take them: points that receive, polygons
// that shoot. Coordinates are float, relative to RayCaster::middle().
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/math/vector.h"

namespace exitance {

/// Points with unit normals, one array per coordinate; `key` picks a point's sample pattern.
struct Receivers {
    std::vector<float> x, y, z, nx, ny, nz;
    std::vector<std::uint32_t> key;

    std::size_t size() const { return x.size(); }
    Vec3f point(std::size_t i) const { return {x[i], y[i], z[i]}; }
    Vec3f normal(std::size_t i) const { return {nx[i], ny[i], nz[i]}; }
    void add(const Vec3& point, const Vec3& normal, std::uint32_t pattern) {
        x.push_back(static_cast<float>(point.x));
        y.push_back(static_cast<float>(point.y));
        z.push_back(static_cast<float>(point.z));
        nx.push_back(static_cast<float>(normal.x));
        ny.push_back(static_cast<float>(normal.y));
        nz.push_back(static_cast<float>(normal.z));
        key.push_back(pattern);
    }
    std::size_t bytes() const { return x.capacity() * 7 * sizeof(float); }
};

/// A convex polygon that owns what it covers of a source's plane: inside where inward · p > offset
/// for all four sides (a triangle repeats one).
struct Cover {
    std::array<Vec3f, 4> inward;
    std::array<float, 4> offset;

    bool contains(const Vec3f& p) const {
        for (std::size_t i = 0; i < 4; ++i)
            if (dot(inward[i], p) <= offset[i]) return false;
        return true;
    }
};

/// A convex planar source of three or four corners, counter-clockwise seen from its lit front.
struct Source {
    std::array<Vec3f, 4> corners;
    std::uint32_t count = 4;
    Vec3f normal;
    float area = 0;
    std::span<const Cover> covers{};  ///< what is covered sends nothing (place_owners.h)

    /// `points`: first `n` are the corners, in world coordinates.
    Source(const std::array<Vec3, 4>& points, std::uint32_t n, const Vec3& middle);
};

/// Up to `capacity` receivers in registers' order, the unit of parallel work.
struct alignas(64) ReceiverBlock {
    static constexpr std::size_t capacity = 256;
    std::array<float, capacity> x, y, z, nx, ny, nz;
    std::array<std::uint32_t, capacity> key;
    std::size_t size = 0;

    /// Receivers `which[0 … n)`, increasing, n ≤ capacity; the rest is filled with copies of the
    /// last.
    void load(const Receivers& all, const std::uint32_t* which, std::size_t n);
};

}  // namespace exitance
