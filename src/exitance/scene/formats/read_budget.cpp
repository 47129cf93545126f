// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/read_budget.h"

#include <fmt/format.h>

namespace exitance {

void ReadBudget::refuse(const Place& place, std::uint64_t most, const char* what,
                        const char* option) {
    throw Error(place, fmt::format("this makes more than {} {}, counted as often as arrays and "
                                   "included files repeat them; {} raises the limit",
                                   most, what, option));
}

}  // namespace exitance
