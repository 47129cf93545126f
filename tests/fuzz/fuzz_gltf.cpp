// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>

#include "exitance/scene/formats/gltf.h"
#include "fuzz/reads_or_refuses.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace exitance;
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    ReadOptions options;  // small, that small files cannot ask for much work
    options.max_polygons = 100'000;
    options.max_texture_pixels = 1'000'000;
    return fuzz::reads_or_refuses("t.glb", [&] { return parse_gltf("t.glb", bytes, options); });
}
