// SPDX-License-Identifier: Apache-2.0
// A picture of a solution from a camera.
#pragma once

#include "exitance/render/image.h"
#include "exitance/render/options.h"
#include "exitance/scene/scene.h"
#include "exitance/solution/surfaces.h"

namespace exitance {

/// Linear radiance B/π seen by `camera` [exitance unit / sr], the light groups weighted; grey
/// where the bands are not R, G, B. `surfaces` made with Backs::open.
Image render_radiance(const Surfaces& surfaces, const Camera& camera, ImageSize size,
                      const RenderOptions& options);

/// What a screen shows, as linear display values: tone mapped or in false colours, with overlays.
Image render_display(const Surfaces& surfaces, const Camera& camera, ImageSize size,
                     const RenderOptions& options);

/// The size asked for, or 768 rows as wide as the camera says (4:3 if it does not).
ImageSize size_of_picture(const RenderOptions& options, const Camera& camera);

}  // namespace exitance
