// SPDX-License-Identifier: Apache-2.0
#include "human_number.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace exitance::cli {

std::string human_number(double value) {
    const double size = std::abs(value);
    return size >= 1000 && size < 1e9 ? fmt::format("{:.0f}", value)
                                      : fmt::format("{:.4g}", value + 0.0);  // −0 becomes 0
}

std::string human_percent(double fraction) {
    const double value = 100 * fraction;
    return std::abs(value) < 99.5 ? fmt::format("{:.2g} %", value) : fmt::format("{:.0f} %", value);
}

std::string human_quantity(double value, const std::string& unit) {
    return human_number(value) + (unit.empty() ? "" : " ") + unit;
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

std::string plural(std::size_t count, const std::string& one, const std::string& several) {
    return fmt::format("{} {}", count, count == 1 ? one : several);
}

}  // namespace exitance::cli
