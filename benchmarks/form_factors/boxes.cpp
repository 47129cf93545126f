// SPDX-License-Identifier: Apache-2.0
#include "form_factors/boxes.h"

#include "exitance/run/random.h"

namespace exitance {

namespace {

/// Of a cube: walls that have a door, by bits of 2 · axis + (the high one of the two).
using Doors = unsigned;

// A door is as wide as the middle third of a wall and two thirds as high; facets that begin in it
// are missing.
bool is_in_door(const Vec3& low, const Vec3& corner, std::size_t axis) {
    const Vec3 at = low - corner;
    const double across = axis == 0 ? at.y : at.x;
    return across > 0.33 && across < 0.66 && at.z < 0.66;
}

// The six faces of a cube with one corner at `corner`, seen from inside or outside.
void add_cube(Enclosure& enclosure, const Vec3& corner, double side, std::size_t n, bool inside,
              Doors doors = 0) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const bool high : {false, true}) {
            Vec3 u, v, from = corner;
            u[(axis + 1) % 3] = 1;
            v[(axis + 2) % 3] = 1;
            if (high) from[axis] += side;
            // u × v points up the axis: into the cube from its low face, out of it from its high
            // one.
            if (high == inside) std::swap(u, v);
            for (std::size_t j = 0; j < n; ++j)
                for (std::size_t i = 0; i < n; ++i) {
                    const auto at = [&](std::size_t a, std::size_t b) {
                        return from + u * (side * double(a) / double(n)) +
                               v * (side * double(b) / double(n));
                    };
                    Facet facet;
                    facet.outline = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
                    const Vec3 low = min(facet.outline[0], facet.outline[2]);
                    if ((doors >> (2 * axis + (high ? 1 : 0)) & 1) && is_in_door(low, corner, axis))
                        continue;
                    facet.normal = cross(u, v);
                    facet.area = side * side / double(n * n);
                    facet.row = static_cast<std::uint32_t>(enclosure.surfaces.size());
                    enclosure.facets.push_back(facet);
                    enclosure.surfaces.push_back({std::to_string(facet.row + 1), facet.area, 1});
                }
        }
}

}  // namespace

Enclosure empty_room(std::size_t n) {
    Enclosure room;
    add_cube(room, {0, 0, 0}, 1, n, true);
    return room;
}

Enclosure room_with_cube(std::size_t n, std::size_t m, double side) {
    Enclosure room = empty_room(n);
    const double at = 0.5 * (1 - side);
    add_cube(room, {at, at, at}, side, m, false);
    return room;
}

namespace {

void add_clutter(Enclosure& enclosure, const Vec3& corner, std::size_t k, std::size_t m,
                 std::uint64_t key) {
    const double cell = 1 / double(k), side = 0.4 * cell;
    for (std::size_t c = 0; c < k * k * k; ++c) {
        const auto place = [&](std::size_t index, std::uint64_t axis) {
            const double shift = uniform(hash_bits(key * k * k * k + c, axis), 0) - 0.5;
            return cell * (double(index) + 0.5 + 0.5 * shift) - 0.5 * side;
        };
        const Vec3 at{place(c / (k * k), 0), place(c / k % k, 1), place(c % k, 2)};
        add_cube(enclosure, corner + at, side, m, false);
    }
}

}  // namespace

Enclosure cluttered_room(std::size_t n, std::size_t k, std::size_t m) {
    Enclosure room = empty_room(n);
    add_clutter(room, {0, 0, 0}, k, m, 0);
    return room;
}

Enclosure building(std::size_t rooms, std::size_t n, std::size_t k, std::size_t m) {
    Enclosure enclosure;
    for (std::size_t x = 0; x < rooms; ++x)
        for (std::size_t y = 0; y < rooms; ++y) {
            const Vec3 corner(double(x), double(y), 0);
            const Doors doors = (x > 0 ? 1u : 0u) | (x + 1 < rooms ? 2u : 0u) | (y > 0 ? 4u : 0u) |
                                (y + 1 < rooms ? 8u : 0u);
            add_cube(enclosure, corner, 1, n, true, doors);
            add_clutter(enclosure, corner, k, m, x * rooms + y);
        }
    return enclosure;
}

}  // namespace exitance
