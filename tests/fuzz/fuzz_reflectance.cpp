// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "exitance/scene/formats/afit_reflectance.h"
#include "fuzz/reads_or_refuses.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace exitance;
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    return fuzz::reads_or_refuses("t.reflectance", [&] {
        const AfitReflectance read = parse_afit_reflectance("t.reflectance", bytes);
        if (read.coefficients.empty()) std::abort();
        return Scene{};
    });
}
