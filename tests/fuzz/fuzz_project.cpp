// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>

#include "exitance/scene/formats/project.h"
#include "fuzz/reads_or_refuses.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace exitance;
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    ReadOptions options;  // small, that small files cannot ask for much work
    options.max_luminaires = 100;
    options.max_polygons = 10'000;
    return fuzz::reads_or_refuses("t.toml", [&] {
        return parse_project(
            "t.toml", bytes,
            [](const std::filesystem::path&, const Place& at) -> Scene {
                throw Error(at, "no files here");
            },
            options);
    });
}
