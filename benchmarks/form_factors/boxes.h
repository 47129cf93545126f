// SPDX-License-Identifier: Apache-2.0
// Enclosures to measure form factors in: a unit room, empty, with one cube or with many.
#pragma once

#include "exitance/formfactor/enclosure.h"

namespace exitance {

/// The inside of the unit cube, n × n facets a wall.
Enclosure empty_room(std::size_t n);
/// And a cube of side `side` in its middle, m × m facets a face.
Enclosure room_with_cube(std::size_t n, std::size_t m, double side);
/// And k³ cubes of side 0.4 / k, each shifted at random by up to a quarter of its place.
Enclosure cluttered_room(std::size_t n, std::size_t k, std::size_t m);

/// rooms × rooms unit rooms on one floor with doors between neighbours, n × n facets a wall, in
/// each k³ cubes as above.
Enclosure building(std::size_t rooms, std::size_t n, std::size_t k, std::size_t m);

}  // namespace exitance
