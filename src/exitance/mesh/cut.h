// SPDX-License-Identifier: Apache-2.0
// A polygon cut along its contacts, so that no element lies on both sides of one (discontinuity
// meshing after Heckbert 1992 and Lischinski, Tampieri & Greenberg 1992, for the zeroth order:
// lines across which light jumps).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/mesh/contacts.h"

namespace exitance {

/// A convex part of a cut polygon. Corners are numbers of places; side i runs from corner i to the
/// next, along a line of the polygon from `begin` to `end` of its length.
struct Piece {
    struct Side {
        std::uint32_t line = 0;
        double begin = 0, end = 1;
    };
    std::uint32_t count = 0;
    std::array<std::uint32_t, 4> corners{};
    std::array<Side, 4> sides{};
};

/// A straight line that bounds pieces: first the polygon's own sides, then the cuts.
struct CutLine {
    struct Mark {
        double at;  ///< of the way from `from` to `to`
        std::uint32_t place;
    };
    /// A part on which something stands. An end is open where light gets round.
    struct Contacted {
        double begin, end;
        bool open_begin, open_end;
        std::uint32_t polygon;  ///< that stands there
    };
    std::uint32_t from, to;
    std::vector<Mark> marks;  ///< places of other lines' ends between this one's own
    std::vector<Contacted> contacts;
};

struct CutPolygon {
    std::vector<Vec3> places;  ///< the polygon's corners first
    std::vector<CutLine> lines;
    std::vector<Piece> pieces;
};

/// Cuts a convex, flat polygon along `contacts` in their order. Places closer than `snap` [m] are
/// one.
CutPolygon cut(std::span<const Vec3> corners, std::span<const Contact> contacts, double snap);

}  // namespace exitance
