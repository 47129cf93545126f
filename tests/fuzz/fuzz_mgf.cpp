// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>

#include "exitance/scene/formats/mgf.h"
#include "fuzz/reads_or_refuses.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace exitance;
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    ReadOptions options;  // small enough for many runs
    options.max_polygons = 2000;
    options.max_lines = 20'000;
    options.max_file_size = 1e-3;
    return fuzz::reads_or_refuses("t.mgf", [&] { return parse_mgf("t.mgf", bytes, options); });
}
