// SPDX-License-Identifier: Apache-2.0
// Where polygons stand on one another. Light differs across such a line, often all of it: a wall
// that meets the middle of a floor parts it into two rooms.
#pragma once

#include <cstdint>
#include <vector>

#include "exitance/math/vector.h"
#include "exitance/scene/scene.h"

namespace exitance {

/// A line on a polygon on which another one stands, or along which that one passes through it.
struct Contact {
    Vec3 from, to;
    std::uint32_t polygon = 0;  ///< the other one
};

/// Contacts of every polygon, longest first, none shorter than `shortest` [m] but the outlines of
/// lamps that lie in its plane. A gap of `tolerance` [m] still is a contact. Polygons that are not
/// flat within it, or smaller than `shortest`, have none.
std::vector<std::vector<Contact>> find_contacts(const Scene& scene, double shortest,
                                                double tolerance);

}  // namespace exitance
