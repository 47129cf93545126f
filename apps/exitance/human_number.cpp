// SPDX-License-Identifier: Apache-2.0
#include "human_number.h"

#include <fmt/format.h>

#include <array>

namespace exitance::cli {

std::string human_quantity(double value, const std::string& unit) {
    return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit);
}

std::string human_count(double value) {
    constexpr std::array<const char*, 5> prefixes{"", " k", " M", " G", " T"};
    std::size_t prefix = 0;
    while (value >= 999.5 && prefix + 1 < prefixes.size()) {
        value /= 1000;
        ++prefix;
    }
    return fmt::format("{:.3g}{}", value, prefixes[prefix]);
}

}  // namespace exitance::cli
