// SPDX-License-Identifier: Apache-2.0
// Faces that lie in one another's place: where two share a plane and face the same way, it is
// chance which of them light falls on.
#pragma once

#include <cstdint>
#include <vector>

#include "exitance/scene/scene.h"

namespace exitance {

struct FacePair {
    std::uint32_t first, second;  ///< into Scene::polygons, first < second
};

struct FaceOverlaps {
    std::vector<FacePair> duplicates;  ///< the same corners, facing the same way
    std::vector<FacePair> overlaps;    ///< share area in one plane, facing the same way
    bool complete = true;              ///< false: given up, there were too many to look at
};

/// Polygons without area are left out, coordinates must be finite. Faces back to back are no
/// overlap. Time grows with polygons × sizes of polygons in one plane, not with pairs.
FaceOverlaps find_overlaps(const Scene& scene);

}  // namespace exitance
