// SPDX-License-Identifier: Apache-2.0
// What is lost on the way into a format.
#pragma once

#include <string>
#include <vector>

#include "exitance/scene/scene.h"

namespace exitance {

/// What a format can carry of a scene.
struct Carries {
    bool quads = true, surface_names = true, material_names = true, shading_normals = true;
    bool one_sided = true;  ///< surfaces that do not emit
    bool two_sided_emission = true;
    bool emitters_reflect = true;
    bool specular = false, transmittance = false, diffuse_transmittance = false;
    bool patches = false;  ///< numbers of patches
    std::size_t cameras = 0;
};

/// A sentence for each thing in `scene` that the format cannot carry.
std::vector<std::string> losses(const Scene& scene, const Carries& carries);

/// By what emission is multiplied to be in `wanted`, 1 where either has no unit; tells in `out`.
double emission_factor(const Scene& scene, Quantity wanted, std::vector<std::string>& out);

/// One word for each name, all different; tells in `out` if any had to be changed.
std::vector<std::string> words_of(const std::vector<std::string>& names, bool unique,
                                  const std::string& what, std::vector<std::string>& out);
std::vector<std::string> material_words(const Scene& scene, std::vector<std::string>& out);
std::vector<std::string> surface_words(const Scene& scene, std::vector<std::string>& out);

/// Polygons of each surface, in their order.
std::vector<std::vector<const Polygon*>> polygons_by_surface(const Scene& scene);

}  // namespace exitance
