// SPDX-License-Identifier: Apache-2.0
// What the error of a patch matters to somebody who looks at a part of the scene only: importance
// is to readings what exitance is to light, and is spread by the same form factors the other way
// (Smits, Arvo and Salesin 1992, "An importance-driven radiosity algorithm").
#pragma once

#include <cstdint>
#include <vector>

#include "exitance/solve/radiosity.h"

namespace exitance {

/// Who looks.
struct Focus {
    struct Ray {
        Vec3 origin, direction;
    };
    std::vector<Ray> sight;    ///< of cameras
    std::vector<Ray> sensors;  ///< with their unit normals
    double reach = 0;          ///< a surface this near is what a sensor lies on [m]

    bool empty() const { return sight.empty() && sensors.empty(); }
};

/// One entry per patch.
struct Importance {
    /// What an error of its irradiance is worth where it is looked at, 0 … 1; 0 = nobody looks.
    std::vector<float> shown;
    /// How often it is looked at: half by area, half by how much of the pictures it fills; where
    /// nobody but sensors look, `shown`. Σ weight · area = Σ shown · area.
    std::vector<float> weight;
    /// What an error of its irradiance brings there by reflection, as long as it has the same sign
    /// everywhere: mean error brought = Σ echo · area · error / Σ shown · area.
    std::vector<float> echo;

    /// What the tolerance of direct light is divided by; 0 = whatever it is will do.
    std::vector<float> of_direct_light() const;
};

/// Throws Error(wrong_use) if no surface is looked at.
Importance find_importance(const Radiosity& radiosity, const Focus& focus, std::uint64_t seed);

}  // namespace exitance
