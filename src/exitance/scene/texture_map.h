// SPDX-License-Identifier: Apache-2.0
// How a texture lies on a polygon.
#pragma once

#include "exitance/scene/scene.h"

namespace exitance {

/// From places on a polygon to places on a texture, affine through its first three corners.
class TextureMap {
  public:
    /// `at`: of the first three corners.
    TextureMap(const std::array<Vec3, 4>& corners, const std::array<TexturePoint, 3>& at);

    TexturePoint operator()(const Vec3& place) const;

  private:
    Vec3 origin_, along_u_, along_v_;
    double u_, v_;
};

TextureMap reflectance_map(const Scene& scene, const Polygon& polygon);
TextureMap exitance_map(const Scene& scene, const Polygon& polygon);

/// Emission of a polygon, the mean over it [exitance_unit].
Spectrum mean_exitance(const Scene& scene, const Polygon& polygon);
/// Diffuse reflectance of a polygon, the mean over it.
Spectrum mean_reflectance(const Scene& scene, const Polygon& polygon);

}  // namespace exitance
