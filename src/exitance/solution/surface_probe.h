// SPDX-License-Identifier: Apache-2.0
// Irradiance read off the solved surface at a point (probe --method interpolate).
#pragma once

#include <optional>
#include <span>

#include "exitance/solution/surfaces.h"

namespace exitance {

struct SurfaceProbeOptions {
    /// How far a point may lie from its surface, in diagonals of the scene: forgives coordinates
    /// rounded to a millimetre in a room, and flat facets of a curved surface.
    double tolerance = 3e-3;
    /// Least cosine between the point's normal and the triangle's: at an edge between two walls
    /// the one that is meant is chosen, and never the far side of a board.
    double least_facing = 0.5;
};

/// The place on the nearest triangle that faces along `normal` (unit), nearer than the tolerance;
/// among triangles at the same distance the one that faces best.
std::optional<SurfacePlace> find_surface(const Surfaces& surfaces, const Vec3& point,
                                         const Vec3& normal,
                                         const SurfaceProbeOptions& options = {});

/// Irradiance at `point` on the side of `normal` (unit), per column [irradiance_unit]. False, and
/// `columns` as it was, where no surface is near.
bool probe_surface(const Surfaces& surfaces, const Vec3& point, const Vec3& normal,
                   std::span<double> columns, const SurfaceProbeOptions& options = {});

}  // namespace exitance
