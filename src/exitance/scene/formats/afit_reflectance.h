// SPDX-License-Identifier: Apache-2.0
// AFIT reflectance files: the BRDF of a material as Legendre coefficients (docs/formats.md).
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/scene/scene.h"

namespace exitance {

/// Shares of the light that are mirrored (Ks) and spread evenly (Kd), and what the mirrored share
/// looks like around the mirror direction: Σ a_l P_l(cos θ).
struct AfitReflectance {
    double specular = 0, diffuse = 1;  ///< Ks, Kd: 0 … 1, together at most 1
    std::vector<double> coefficients;  ///< a_0 … a_L
};

/// Throws Error(bad_input) with file:line:column.
AfitReflectance parse_afit_reflectance(const std::string& file, std::string_view text);
AfitReflectance read_afit_reflectance(const std::filesystem::path& path);
void write_afit_reflectance(const AfitReflectance& reflectance, std::ostream& out);

/// Gives each material with a number m the reflectances of `stem.m.reflectance`, or else
/// `m.reflectance`, beside `geometry`: its colour times Kd and, mirror-like, times Ks. Where there
/// is no such file the colour stays, with a note. Throws Error(bad_input).
void apply_afit_reflectances(Scene& scene, const std::filesystem::path& geometry);

}  // namespace exitance
