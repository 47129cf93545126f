// SPDX-License-Identifier: Apache-2.0
// AFIT geometry and display files, as the original system wrote them (docs/formats.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

#include "exitance/scene/scene.h"

namespace exitance {

/// A display file: who looks, and how the original program solved.
struct AfitDisplay {
    std::string comment;
    Vec3 eye, look_at, up{0, 1, 0};
    double fov_x = 45, fov_y = 45;    ///< full angles [degrees]
    std::optional<double> near, far;  ///< [m]
    std::uint32_t width = 640;        ///< xres [pixels]
    std::uint32_t height = 480;       ///< yres [pixels]
    std::optional<double> diameter;   ///< as written
    std::optional<bool> ambient;      ///< show the ambient estimate while solving
    std::optional<double> threshold;  ///< stop when 1000 × next shooter / total falls below
};

/// The camera of a display file; its aspect is tan(fovx/2) / tan(fovy/2).
Camera camera_of(const AfitDisplay& display);

/// Is this the text of a geometry file? (Its counts stand on the second or third line.)
bool looks_like_afit_geometry(std::string_view text);

/// Reads a geometry file from its `text`; `file` is what errors name. One Material and one Surface
/// per attribute, unitless. Throws Error(bad_input) with file:line:column.
Scene parse_afit_geometry(const std::string& file, std::string_view text);
Scene read_afit_geometry(const std::filesystem::path& path);

/// Reads a display file. Throws Error(bad_input) with file:line:column.
AfitDisplay parse_afit_display(const std::string& file, std::string_view text);
AfitDisplay read_afit_display(const std::filesystem::path& path);

/// Writes a display file; `out` is left for the caller to check.
void write_afit_display(const AfitDisplay& display, std::ostream& out);
/// What a display file says of a camera; 480 pixels high.
AfitDisplay display_of(const Camera& camera);

}  // namespace exitance
