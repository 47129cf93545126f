// SPDX-License-Identifier: Apache-2.0
// Pictures of the whole surroundings, from .hdr and .exr files.
#pragma once

#include <filesystem>

#include "exitance/run/error.h"
#include "exitance/scene/read_options.h"
#include "exitance/scene/sky.h"

namespace exitance {

/// Reads an equirectangular picture: its middle row is the horizon, its top the zenith, and its
/// middle column is seen towards −z; `rotation` degrees turn it counter-clockwise seen from above.
/// Cells of the map keep the light that falls on them exactly, so a sun of a few pixels keeps its
/// flux, spread over cells of a degree to a quarter of one. Throws Error at `named` for what cannot
/// be read or is larger than `options` allow.
RadianceMap read_environment_map(const std::filesystem::path& path, double rotation,
                                 const Place& named, const ReadOptions& options);

}  // namespace exitance
