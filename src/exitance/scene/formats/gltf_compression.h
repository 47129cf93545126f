// SPDX-License-Identifier: Apache-2.0
// Geometry that a glTF holds compressed: EXT_meshopt_compression and KHR_draco_mesh_compression,
// decoded by the libraries of their makers.
#pragma once

#include "exitance/scene/formats/json_text.h"

namespace tinygltf {
class Model;
}

namespace exitance {

/// Replaces compressed bufferViews, and the accessors of compressed primitives, by what they stand
/// for. Throws Error(bad_input) for damaged data, before more memory is taken than it can fill.
void decompress_gltf(tinygltf::Model& model, const JsonText& json);

}  // namespace exitance
