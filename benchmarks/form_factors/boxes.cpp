// SPDX-License-Identifier: Apache-2.0
#include "form_factors/boxes.h"

#include "exitance/run/random.h"

namespace exitance {

namespace {

// The six faces of a cube with one corner at `corner`, seen from inside or outside.
void add_cube(Enclosure& enclosure, const Vec3& corner, double side, std::size_t n, bool inside) {
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

Enclosure cluttered_room(std::size_t n, std::size_t k, std::size_t m) {
    Enclosure room = empty_room(n);
    const double cell = 1 / double(k), side = 0.4 * cell;
    for (std::size_t c = 0; c < k * k * k; ++c) {
        const auto place = [&](std::size_t index, std::uint64_t axis) {
            return cell * (double(index) + 0.5 + 0.5 * (uniform(hash_bits(c, axis), 0) - 0.5)) -
                   0.5 * side;
        };
        add_cube(room, {place(c / (k * k), 0), place(c / k % k, 1), place(c % k, 2)}, side, m,
                 false);
    }
    return room;
}

}  // namespace exitance
