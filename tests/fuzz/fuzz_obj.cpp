// SPDX-License-Identifier: Apache-2.0
// OBJ through the importer in its own process, as it is read for people.
#include <cstddef>
#include <cstdint>

#include "exitance/scene/formats/general_geometry.h"
#include "fuzz/reads_or_refuses.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace exitance;
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    return fuzz::reads_or_refuses("t.obj", [&] { return parse_general_geometry("t.obj", bytes); });
}
