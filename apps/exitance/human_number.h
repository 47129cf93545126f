// SPDX-License-Identifier: Apache-2.0
// Numbers as they are read aloud.
#pragma once

#include <cstddef>
#include <string>

namespace exitance::cli {

/// Three digits and a prefix: "3.4 M", "57 k", "12".
std::string human_count(double value);

/// Four significant digits, whole numbers in full: "0.01234", "12.31", "39789".
std::string human_number(double value);

/// Two digits, or whole numbers in full: 0.021 as "2.1 %", 1 as "100 %".
std::string human_percent(double fraction);

/// A number and the unit, if there is one: "12.31 lm".
std::string human_quantity(double value, const std::string& unit);

/// "1 lamp", "2 lamps".
std::string plural(std::size_t count, const std::string& one, const std::string& several);

}  // namespace exitance::cli
