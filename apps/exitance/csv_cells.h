// SPDX-License-Identifier: Apache-2.0
// Lines of comma-separated values, cell by cell, as tables of points and of surfaces are read.
#pragma once

#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace exitance::cli {

struct Cell {
    std::string_view text;
    std::size_t column;  ///< of its first character, from 1
};

/// Without blanks around it.
std::string_view trimmed(std::string_view text);

/// Without the quotes around it, if there are some.
std::string_view unquoted(std::string_view text);

/// The cells of a line; a quoted cell keeps its quotes, and its commas do not count.
std::vector<Cell> cells_of(std::string_view line);

/// The next line without its ending; false at the end of the input.
bool next_line(std::istream& in, std::string& line);

/// A cell as it is written: in quotes if it needs them.
std::string csv_cell(const std::string& text);

}  // namespace exitance::cli
