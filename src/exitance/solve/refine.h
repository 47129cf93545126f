// SPDX-License-Identifier: Apache-2.0
// Adaptive subdivision: elements are split where the light of a bright shooter is not what
// interpolation between their corners says.
#pragma once

#include <functional>
#include <vector>

#include "exitance/solve/cast_light.h"
#include "exitance/solve/radiosity.h"

namespace exitance {

struct RefineOptions {
    float tolerance = 0;  ///< irradiance (luminance) that may be wrong
    float min_area = 0;   ///< elements below this area stay [m²]
    /// Test every element that gets light, not only those whose corners differ.
    bool thorough = false;
};

/// Lights any receivers with the shooter in question, into a reset `Received`. Returns rays cast.
using Illuminate = std::function<std::uint64_t(const Receivers&, Received&)>;

/// Splits leaves until the shooter's light interpolates within the tolerance or elements are small.
/// `received` (one entry per vertex) grows by the new vertices. Their irradiance row starts as the
/// interpolation of their parents' when `interpolate_earlier` is set: earlier shooters passed this
/// very test on the element, so re-evaluating them would change little; the present shooter is
/// evaluated exactly. Returns rays cast.
std::uint64_t refine(Radiosity& radiosity, const RefineOptions& options,
                     const Illuminate& illuminate, bool interpolate_earlier, Received& received);

}  // namespace exitance
