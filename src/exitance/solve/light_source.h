// SPDX-License-Identifier: Apache-2.0
// What one shot sends out: a polygon with uniform exitance, or a patch whose exitance varies over
// its quadtree.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "exitance/solve/radiosity.h"
#include "exitance/visibility/receivers.h"

namespace exitance {

/// A node's exitance is the mean of its children's, weighted by the area that is not covered. A
/// receiver takes light from a node as a whole where that changes its irradiance by less than the
/// tolerance, and from the children otherwise.
struct LightSource {
    struct Node {
        Source source;
        float open_area = 0;            ///< not covered by other objects [m²]
        std::uint32_t number = 0;       ///< decorrelates the samples
        std::uint32_t first_child = 0;  ///< four nodes in a row; 0 = none
        float luminance = 0;            ///< of the exitance
        float magnitude = 0;            ///< the same, of its columns' absolute values
        float spread = 0;               ///< magnitude of the largest difference to a descendant
    };
    std::vector<Node> nodes;      ///< root first
    std::vector<float> exitance;  ///< nodes × stride

    std::span<const float> row(std::size_t node, std::size_t stride) const {
        return {&exitance[node * stride], stride};
    }
};

/// Of the samples of a face that emits.
std::uint32_t number_of_face(FaceId face);
/// The emission of a whole face, divided for receivers near to it.
LightSource emission_of(const Radiosity& radiosity, FaceId face);

/// What a patch still has to shoot, element by element: ρ H − shot, plus ρ times `ambient`
/// [columns.stride], the share of overshooting.
LightSource unshot_of(const Radiosity& radiosity, PatchId patch, std::span<const float> ambient);

/// All that a patch has shot so far, without the emission.
LightSource shot_of(const Radiosity& radiosity, PatchId patch);

}  // namespace exitance
