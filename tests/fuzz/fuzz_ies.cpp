// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>

#include "exitance/scene/formats/ies.h"
#include "fuzz/lamp_scene.h"
#include "fuzz/reads_or_refuses.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace exitance;
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    return fuzz::reads_or_refuses("t.ies", [&] {
        // A tilt file is what stands after the first form feed.
        return fuzz::lamp_scene(parse_ies("t.ies", bytes, [&](const std::string& name) {
            const std::size_t at = bytes.find('\f');
            return TiltFile{name, std::string(bytes.substr(at == bytes.npos ? size : at + 1))};
        }));
    });
}
