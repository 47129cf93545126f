// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>

#include "exitance/scene/formats/view3d.h"
#include "fuzz/reads_or_refuses.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace exitance;
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    return fuzz::reads_or_refuses("t.vs3", [&] { return parse_view3d("t.vs3", bytes); });
}
