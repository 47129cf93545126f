// SPDX-License-Identifier: Apache-2.0
// Light groups: sets of emitters that can be dimmed together after the solve, because light is
// linear.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exitance/scene/scene.h"

namespace exitance {

struct LightGroup {
    std::string name;
    double weight = 1;  ///< how strongly it counts in the picture and in adaptive decisions
};

/// How emitters are gathered into groups (--groups).
enum class Grouping {
    none,       ///< all light in one group
    luminaire,  ///< every lamp of the project, and every other emitting surface, by its own
    material,   ///< one group per emitting material; luminaires, which have none, by name
    file        ///< as the file names them; emitters it does not name share the group "light"
};

struct LightGroups {
    std::vector<LightGroup> groups;                 ///< at least one
    std::vector<std::uint32_t> group_of_surface;    ///< per Scene surface; 0 for what does not emit
    std::vector<std::uint32_t> group_of_luminaire;  ///< per Scene luminaire
    std::vector<std::uint32_t> group_of_distant;    ///< per Scene distant light
};

/// Groups in order of first appearance among the surfaces, the luminaires, sun and sky.
LightGroups make_groups(const Scene& scene, Grouping grouping);

}  // namespace exitance
