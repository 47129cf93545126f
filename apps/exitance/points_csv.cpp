// SPDX-License-Identifier: Apache-2.0
#include "points_csv.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <istream>
#include <optional>
#include <ostream>
#include <string_view>

#include "csv_cells.h"
#include "exitance/run/error.h"
#include "exitance/scene/formats/limits.h"
#include "exitance/solution/probe.h"

namespace exitance::cli {

namespace {

constexpr std::array<std::string_view, 6> names{"x", "y", "z", "nx", "ny", "nz"};

using Indices = std::array<std::size_t, 6>;

Indices find_columns(const std::vector<Cell>& header, const std::string& name) {
    Indices out;
    for (std::size_t k = 0; k < names.size(); ++k) {
        std::optional<std::size_t> found;
        for (std::size_t i = 0; i < header.size(); ++i) {
            if (unquoted(header[i].text) != names[k]) continue;
            if (found)
                throw Error(Place{name, 1, header[i].column},
                            fmt::format("found a second column '{}'", names[k]));
            found = i;
        }
        if (!found)
            throw Error(Place{name, 1, 1},
                        fmt::format("found no column '{}', expected a header with x,y,z,nx,ny,nz",
                                    names[k]));
        out[k] = *found;
    }
    return out;
}

double number_of(const Cell& cell, std::string_view column, const Place& line) {
    double value = 0;
    const char* end = cell.text.data() + cell.text.size();
    const auto [rest, failure] = std::from_chars(cell.text.data(), end, value);
    if (failure != std::errc{} || rest != end || !std::isfinite(value))
        throw Error(Place{line.file, line.line, cell.column},
                    fmt::format("found '{}', expected a number for {}", cell.text, column));
    if (!(std::abs(value) <= limits::coordinate))
        throw Error(Place{line.file, line.line, cell.column},
                    fmt::format("found {} = {}, expected at most 1e9 m", column, cell.text));
    return value;
}

}  // namespace

PointTable read_points(std::istream& in, const std::string& name) {
    PointTable table;
    if (!next_line(in, table.header))
        throw Error(Place{name, 1, 1}, "found nothing, expected a header with x,y,z,nx,ny,nz");
    if (table.header.starts_with("\xef\xbb\xbf")) table.header.erase(0, 3);
    const std::vector<Cell> header = cells_of(table.header);
    const Indices columns = find_columns(header, name);

    std::string line;
    for (std::size_t number = 2; next_line(in, line); ++number) {
        if (trimmed(line).empty()) continue;
        const std::vector<Cell> cells = cells_of(line);
        if (cells.size() != header.size())
            throw Error(Place{name, number, cells.back().column},
                        fmt::format("found {} columns, expected {} as in the header", cells.size(),
                                    header.size()));
        std::array<double, 6> v;
        for (std::size_t k = 0; k < v.size(); ++k)
            v[k] = number_of(cells[columns[k]], names[k], Place{name, number});
        const Vec3 normal{v[3], v[4], v[5]};
        const double largest =
            std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
        if (!(largest > 0))
            throw Error(Place{name, number, cells[columns[3]].column},
                        "found a normal of length 0, expected the direction that is faced");
        table.points.push_back({{v[0], v[1], v[2]}, normalized(normal / largest)});
        table.lines.push_back(line);
    }
    if (in.bad()) throw Error(Place{name}, "cannot be read to its end");
    return table;
}

PointTable points_of(const SensorGrid& grid) {
    PointTable table;
    table.header = fmt::format("{}", fmt::join(names, ","));
    const Vec3& n = grid.normal;
    table.points = sensor_points(grid);
    for (const GatherPoint& point : table.points) {
        const Vec3& p = point.position;
        table.lines.push_back(
            fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", p.x, p.y, p.z, n.x, n.y, n.z));
    }
    return table;
}

void write_points(std::ostream& out, const PointTable& table, std::span<const std::string> columns,
                  std::span<const double> values) {
    std::string text = table.header;
    for (const std::string& column : columns) text += "," + column;
    text += '\n';
    for (std::size_t i = 0; i < table.lines.size(); ++i) {
        text += table.lines[i];
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const double value = values[i * columns.size() + c];
            text += std::isnan(value) ? ",nan" : fmt::format(",{:.7g}", value);
        }
        text += '\n';
        if (text.size() < (1u << 16)) continue;
        out << text;
        text.clear();
    }
    out << text;
}

}  // namespace exitance::cli
