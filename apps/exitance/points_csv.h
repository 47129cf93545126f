// SPDX-License-Identifier: Apache-2.0
// Tables of points as probe takes them in, and as it gives them back with more columns.
#pragma once

#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "exitance/scene/scene.h"
#include "exitance/solution/gather.h"

namespace exitance::cli {

struct PointTable {
    std::string header;              ///< the first line as it was
    std::vector<std::string> lines;  ///< of the points, as they were
    std::vector<GatherPoint> points;
};

/// Reads comma-separated values whose header has x, y, z, nx, ny, nz, in any order and among other
/// columns; normals are brought to unit length. `name` is what errors call it. Throws
/// Error(bad_input) with name:line:column.
PointTable read_points(std::istream& in, const std::string& name);

/// The sensors of a grid as a table.
PointTable points_of(const SensorGrid& grid);

/// The lines of `table` with `columns.size()` values per point appended, NaN as "nan".
void write_points(std::ostream& out, const PointTable& table, std::span<const std::string> columns,
                  std::span<const double> values);

}  // namespace exitance::cli
