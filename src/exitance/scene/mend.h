// SPDX-License-Identifier: Apache-2.0
// What a reader leaves becomes what the mesh needs: planar convex polygons with an area, and
// reflectances that let light die out.
#pragma once

#include "exitance/scene/scene.h"

namespace exitance {

/// Largest reflectance that is solved for: at 0.98 light dies out after some hundred reflections,
/// at 1 it never does.
inline constexpr double largest_reflectance = 0.98;

/// Distance from its plane up to which a quad counts as planar, for a scene of this extent [m].
/// The rounding of coordinates kept in six digits or in float, not more.
double planarity_tolerance(double polygon_diagonal, double scene_diagonal);

/// Leaves out corners that repeat and polygons without area, splits quads that are not planar or
/// not convex into triangles, limits reflectances to `largest_reflectance`; says so in
/// Scene::warnings, once per material or surface. Throws Error(bad_input) for what has no meaning:
/// coordinates that are not finite or beyond 1e9 m, reflectances outside 0 … 1, negative exitances.
void mend(Scene& scene);

}  // namespace exitance
