// SPDX-License-Identifier: Apache-2.0
// What a camera sees of a solution: rays through every pixel, filtered.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "exitance/render/camera_rays.h"
#include "exitance/render/image.h"
#include "exitance/solution/surfaces.h"

namespace exitance {

/// A camera ray that met the front of a surface.
struct ViewHit {
    SurfacePlace place;
    double x = 0, y = 0;  ///< where on the image [pixels from the top left corner]
};

struct Raycast {
    Image image;                  ///< mean of what the rays brought, 0 for those that missed
    std::vector<float> coverage;  ///< share of the rays that met a surface, per pixel
};

/// Casts `samples` rays per pixel, spread by a Gaussian filter; each that hits brings
/// `shade(hit)`, called from many threads at once. `surfaces` made with Backs::open: backs do not
/// show. Rays that leave the scene bring `beyond(direction)`, not of unit length, if there is such
/// a function; they do not count as covered. The same arguments give the same image on any number
/// of threads.
Raycast raycast(const Surfaces& surfaces, const CameraRays& camera, std::uint32_t width,
                std::uint32_t height, std::uint32_t samples, std::uint64_t seed,
                const std::function<Vec3f(const ViewHit&)>& shade,
                const std::function<Vec3f(const Vec3&)>& beyond = {});

}  // namespace exitance
