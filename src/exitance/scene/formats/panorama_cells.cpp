// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/panorama_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace exitance {

namespace {

constexpr double pi = std::numbers::pi;
constexpr std::uint32_t coarsest = 7, finest = 9;

// In the square of a hemisphere, (a, b) in [−1, 1]², a parallel is a square around the middle at
// the distance r = √(1 − |cos Z|), and a meridian a straight line from the middle: within each of
// the four sectors between the diagonals it leads to r (1, t), where t grows evenly with the
// azimuth (Shirley & Chiu 1997). So a pixel's part in a sector is a trapezoid, and areas are solid
// angles.
struct ColumnPart {
    std::size_t x;
    std::uint32_t sector;  ///< quarter turns from +x
    double from, to;       ///< t
};
struct RowPart {
    std::size_t y;
    bool lower;
    double from, to;  ///< r
};

std::vector<ColumnPart> column_parts(std::size_t width, double turn) {
    std::vector<ColumnPart> out;
    for (std::size_t x = 0; x < width; ++x) {
        // Columns go round clockwise seen from above, the middle one at −z: in sectors, whose first
        // begins between −z and +x.
        const auto place = [&](std::size_t edge) {
            return 4 * (double(edge) / double(width) - 0.5 - turn / (2 * pi)) - 0.5;
        };
        const double end = place(x + 1);
        for (double at = place(x); at < end;) {
            const double sector = std::floor(at), next = std::min(end, sector + 1);
            const auto quarter = static_cast<std::uint32_t>(sector - 4 * std::floor(sector / 4));
            out.push_back({x, quarter, 2 * (at - sector) - 1, 2 * (next - sector) - 1});
            at = next;
        }
    }
    return out;
}

std::vector<RowPart> row_parts(std::size_t height) {
    std::vector<RowPart> out;
    const auto radius = [](double zenith) { return std::numbers::sqrt2 * std::sin(zenith / 2); };
    for (std::size_t y = 0; y < height; ++y) {
        const double top = pi * double(y) / double(height),
                     bottom = pi * double(y + 1) / double(height);
        if (top < pi / 2) out.push_back({y, false, radius(top), radius(std::min(bottom, pi / 2))});
        if (bottom > pi / 2)
            out.push_back({y, true, radius(pi - bottom), radius(pi - std::max(top, pi / 2))});
    }
    return out;
}

struct At {
    double u, v;
};

// A convex polygon; a trapezoid has 4 corners, and each side of a cell adds one at most.
struct Piece {
    std::array<At, 8> corners{};
    std::size_t count = 0;

    void add(const At& corner) {
        if (count < corners.size()) corners[count++] = corner;
    }
    double area() const {
        double twice = 0;
        for (std::size_t i = 2; i < count; ++i) {
            const At &o = corners[0], &p = corners[i - 1], &q = corners[i];
            twice += (p.u - o.u) * (q.v - o.v) - (p.v - o.v) * (q.u - o.u);
        }
        return std::abs(twice) / 2;
    }
    // What of it lies where sign · (axis − bound) ≥ 0 (Sutherland & Hodgman 1974).
    Piece beyond(double At::*axis, double bound, double sign) const {
        Piece out;
        for (std::size_t i = 0; i < count; ++i) {
            const At &p = corners[i], &q = corners[(i + 1) % count];
            const double dp = sign * (p.*axis - bound), dq = sign * (q.*axis - bound);
            if (dp >= 0) out.add(p);
            if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) {
                const double s = dp / (dp - dq);
                At cut{p.u + s * (q.u - p.u), p.v + s * (q.v - p.v)};
                cut.*axis = bound;
                out.add(cut);
            }
        }
        return out;
    }
};

// The trapezoid of a pixel's part, in cells: [0, n]².
Piece piece_of(const RowPart& row, const ColumnPart& column, double n) {
    Piece out;
    const auto corner = [&](double r, double t) {
        const double along[] = {r, -r * t, -r, r * t};
        const double a = along[column.sector], b = along[(column.sector + 3) % 4];
        out.add({0.5 * n * (a + 1), 0.5 * n * (b + 1)});
    };
    corner(row.from, column.from), corner(row.to, column.from);
    corner(row.to, column.to), corner(row.from, column.to);
    return out;
}

std::uint32_t level_for(const Panorama& picture) {
    // 2π / 4^level against the pixel at the horizon, 2π / width · π / height.
    std::uint32_t level = coarsest;
    while (level < finest &&
           double(1u << (2 * level)) * pi < double(picture.width) * double(picture.height))
        ++level;
    return level;
}

}  // namespace

RadianceMap cells_of(const Panorama& picture, double rotation) {
    RadianceMap map;
    map.level = level_for(picture);
    const std::uint32_t n = map.side();
    std::vector<double> sum(std::size_t{6} * n * n);
    const auto cell_at = [n](double x) {
        return static_cast<std::uint32_t>(std::clamp(x, 0.0, double(n - 1)));
    };
    const std::vector<ColumnPart> columns = column_parts(picture.width, rotation * pi / 180);
    for (const RowPart& row : row_parts(picture.height))
        for (const ColumnPart& column : columns) {
            const float* pixel = picture.at(column.x, row.y);
            const Piece piece = piece_of(row, column, n);
            const auto give = [&](std::uint32_t u, std::uint32_t v, double area) {
                const std::size_t cell = (std::size_t{row.lower} * n + v) * n + u;
                for (std::size_t b = 0; b < 3; ++b) sum[3 * cell + b] += area * double(pixel[b]);
            };
            At least = piece.corners[0], most = least;
            for (const At& corner : std::span(piece.corners).first(piece.count)) {
                least = {std::min(least.u, corner.u), std::min(least.v, corner.v)};
                most = {std::max(most.u, corner.u), std::max(most.v, corner.v)};
            }
            const std::uint32_t u0 = cell_at(least.u), u1 = cell_at(most.u), v0 = cell_at(least.v),
                                v1 = cell_at(most.v);
            if (u0 == u1 && v0 == v1) {
                give(u0, v0, piece.area());
                continue;
            }
            for (std::uint32_t v = v0; v <= v1; ++v) {
                const Piece strip = piece.beyond(&At::v, v, 1).beyond(&At::v, v + 1.0, -1);
                for (std::uint32_t u = u0; u <= u1 && strip.count > 2; ++u)
                    give(u, v, strip.beyond(&At::u, u, 1).beyond(&At::u, u + 1.0, -1).area());
            }
        }
    map.cells.resize(sum.size());
    // A cell's area is 1.
    for (std::size_t i = 0; i < sum.size(); ++i) map.cells[i] = static_cast<float>(sum[i]);
    return map;
}

}  // namespace exitance
