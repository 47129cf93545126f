// SPDX-License-Identifier: Apache-2.0
// The enclosure that a scene is.
#pragma once

#include <optional>
#include <string>

#include "exitance/formfactor/enclosure.h"
#include "exitance/run/options.h"
#include "exitance/scene/scene.h"

namespace exitance {

struct EnclosureOptions {
    /// What a row stands for: a side of a polygon, a patch of the mesh, an element of a patch, a
    /// surface of the scene with all its polygons (both sides of what is two-sided). "" = surface
    /// for a scene with a form-factor setup, else polygon.
    std::string by;
    std::optional<double> patch_size;  ///< longest edge of a patch where the file does not say [m]
    int levels = 1;                    ///< how often a patch is divided in four, for elements
};

/// Every member of `options` with its name, unit, range and reason.
Options describe(EnclosureOptions& options);

/// A scene's form-factor setup (.vs3) is honoured: obstructions only block, surfaces that are
/// combined with another one belong to its row; emissivities are the setup's, else 1 − mean
/// reflectance, area-weighted where polygons are put together. Rows are in the order of the scene.
/// Throws Error(bad_input) if nothing has a row, or surfaces are combined in a circle.
Enclosure make_enclosure(const Scene& scene, const EnclosureOptions& options);

}  // namespace exitance
