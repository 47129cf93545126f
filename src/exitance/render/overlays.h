// SPDX-License-Identifier: Apache-2.0
// The mesh drawn over a picture: its edges, and the normals of its vertices.
#pragma once

#include "exitance/render/camera_rays.h"
#include "exitance/render/image.h"
#include "exitance/solution/surfaces.h"

namespace exitance {

/// Draws the edges of all triangles that show, about a pixel wide (wider on large pictures), on
/// linear display values. Where triangles are smaller than lines their shade stands for them.
void draw_wireframe(Image& image, const Surfaces& surfaces, const CameraRays& camera,
                    std::uint32_t samples, std::uint64_t seed);

/// Draws a line along the normal from vertices that show, as long as 1/40 of the scene's diagonal;
/// of vertices closer than a few lines' widths on the picture only the first.
void draw_normals(Image& image, const Surfaces& surfaces, const CameraRays& camera);

}  // namespace exitance
