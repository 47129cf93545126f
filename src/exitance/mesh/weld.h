// SPDX-License-Identifier: Apache-2.0
// Corners that are one place become one position.
#pragma once

#include <tsl/robin_map.h>

#include <bit>
#include <vector>

#include "exitance/math/box.h"
#include "exitance/mesh/ids.h"
#include "exitance/run/random.h"

namespace exitance {

class Welder {
  public:
    /// Positions are appended to `positions`; those within a small share of the diagonal of
    /// `bounds` are one.
    Welder(const Box& bounds, std::vector<Vec3>& positions);

    PositionId at(const Vec3& point);

    /// Distance within which places are one [m].
    double tolerance() const { return cell_; }

  private:
    struct ExactHash {
        std::size_t operator()(const Vec3& p) const {
            // + 0.0 makes the two zeros equal.
            return hash_bits(std::bit_cast<std::uint64_t>(p.x + 0.0),
                             std::bit_cast<std::uint64_t>(p.y + 0.0),
                             std::bit_cast<std::uint64_t>(p.z + 0.0));
        }
    };
    struct Cell {
        std::int64_t x, y, z;
        friend bool operator==(const Cell&, const Cell&) = default;
    };
    struct CellHash {
        std::size_t operator()(const Cell& c) const {
            return hash_bits(static_cast<std::uint64_t>(c.x), static_cast<std::uint64_t>(c.y),
                             static_cast<std::uint64_t>(c.z));
        }
    };
    Cell cell_of(const Vec3& p) const;

    std::vector<Vec3>& positions_;
    Vec3 lower_;
    double cell_;
    tsl::robin_map<Vec3, PositionId, ExactHash> exact_;
    tsl::robin_map<Cell, PositionId, CellHash> cells_;
};

}  // namespace exitance
