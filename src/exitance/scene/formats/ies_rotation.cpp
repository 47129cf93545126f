// SPDX-License-Identifier: Apache-2.0
// LM-63-2002, section 3: horizontal angles of types A and B run clockwise seen from above; the
// photometric horizontal, our C0, is (0, 90) for type B and (0, 0) for type A; nadir is (0, 0) for
// type B and (0, −90) for type A.
#include "exitance/scene/formats/ies_rotation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace exitance {

namespace {

constexpr double degree = std::numbers::pi / 180;
// Steps of the new table: half the file's, so that ridges stay ridges, within reason.
constexpr double finest = 0.5, coarsest = 2.5;

double smallest_step(const std::vector<double>& verticals, const std::vector<CPlane>& columns) {
    double step = coarsest;
    for (std::size_t i = 1; i < verticals.size(); ++i)
        step = std::min(step, (verticals[i] - verticals[i - 1]) / 2);
    for (std::size_t i = 1; i < columns.size(); ++i)
        step = std::min(step, (columns[i].c - columns[i - 1].c) / 2);
    return std::max(step, finest);
}

// Bilinear in (H, V).
double look_up(const std::vector<double>& verticals, const std::vector<CPlane>& columns, double h,
               double v) {
    constexpr double rounding = 1e-9;
    if (h < columns.front().c - rounding || h > columns.back().c + rounding ||
        v < verticals.front() - rounding || v > verticals.back() + rounding)
        return 0;
    const auto row = std::upper_bound(verticals.begin() + 1, verticals.end() - 1, v);
    const auto j = static_cast<std::size_t>(row - verticals.begin()) - 1;
    const double up = std::clamp((v - verticals[j]) / (verticals[j + 1] - verticals[j]), 0.0, 1.0);
    const auto in_column = [&](const CPlane& column) {
        return column.candela[j] + up * (column.candela[j + 1] - column.candela[j]);
    };
    if (columns.size() == 1) return in_column(columns.front());
    const auto column =
        std::upper_bound(columns.begin() + 1, columns.end() - 1, h,
                         [](double angle, const CPlane& plane) { return angle < plane.c; });
    const CPlane &left = *(column - 1), &right = *column;
    const double across = std::clamp((h - left.c) / (right.c - left.c), 0.0, 1.0);
    return (1 - across) * in_column(left) + across * in_column(right);
}

}  // namespace

Vec3 direction_of(IesType type, double h, double v) {
    const double ch = std::cos(h * degree), sh = std::sin(h * degree);
    const double cv = std::cos(v * degree), sv = std::sin(v * degree);
    if (type == IesType::a) return {cv * ch, -cv * sh, sv};
    return {ch * sv, -sh, -ch * cv};
}

void rotate_to_c_planes(Photometry& photometry, IesType type, const std::vector<double>& verticals,
                        const std::vector<CPlane>& columns) {
    // A whole number of steps to each quarter, so that the axes are on the grid.
    const double steps = std::ceil(90 / smallest_step(verticals, columns));
    const auto quarter = static_cast<std::size_t>(steps);
    photometry.gammas.clear();
    for (std::size_t j = 0; j <= 2 * quarter; ++j)
        photometry.gammas.push_back(90 * static_cast<double>(j) / steps);
    std::vector<CPlane> planes(4 * quarter);
    for (std::size_t i = 0; i < planes.size(); ++i) {
        planes[i].c = 90 * static_cast<double>(i) / steps;
        for (const double gamma : photometry.gammas) {
            const double sine = std::sin(gamma * degree);
            const Vec3 d{sine * std::cos(planes[i].c * degree),
                         sine * std::sin(planes[i].c * degree), -std::cos(gamma * degree)};
            double h, v;
            if (type == IesType::a) {
                h = std::atan2(-d.y, d.x) / degree;
                v = std::atan2(d.z, std::hypot(d.x, d.y)) / degree;
            } else {
                h = std::atan2(-d.y, std::hypot(d.x, d.z)) / degree;
                v = std::atan2(d.x, -d.z) / degree;
            }
            planes[i].candela.push_back(look_up(verticals, columns, h, v));
        }
    }
    // Half-spheres end at the horizon, sharply.
    const auto dark_above = [&](const CPlane& plane) {
        return std::all_of(plane.candela.begin() + static_cast<std::ptrdiff_t>(quarter) + 1,
                           plane.candela.end(), [](double candela) { return candela == 0; });
    };
    if (std::all_of(planes.begin(), planes.end(), dark_above)) {
        photometry.gammas.resize(quarter + 1);
        for (CPlane& plane : planes) plane.candela.resize(quarter + 1);
    }
    set_planes(photometry, std::move(planes), LampSymmetry::none);
    photometry.forward = direction_of(type, 0, 0);
}

}  // namespace exitance
