// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/partial_exchange.h"

#include <algorithm>
#include <cmath>

#include "exitance/math/polygon.h"
#include "exitance/math/quadrature.h"

namespace exitance {

namespace {

// Two-point Gauss on either half of [0, 1]: of fourth order where the integrand is smooth, evenly
// spread where it has kinks.
constexpr double inner = 0.5 - 0.28867513459481287;
constexpr std::array<double, 4> nodes{0.5 * inner, 0.5 * (1 - inner), 0.5 + 0.5 * inner,
                                      1 - 0.5 * inner};
// What a rule twice as fine is off by, as a share of the difference to the coarse one: between 1/4
// (a jump along a line) and 1/16 (smooth).
constexpr double finer = 0.25;
constexpr std::size_t most_cells = 4096, most_agreeing = 256;

// Vanishes where the integrand is linear; a kink across the cell shows in one of the three sums
// whichever way it runs.
double unevenness(const std::array<double, 16>& at) {
    double columns = 0, rows = 0, chequer = 0;
    for (std::size_t k = 0; k < 16; ++k) {
        const std::size_t i = k % 4, j = k / 4;
        columns += i == 0 || i == 3 ? at[k] : -at[k];
        rows += j == 0 || j == 3 ? at[k] : -at[k];
        chequer += (i + j) % 2 ? at[k] : -at[k];
    }
    return 0.25 * (std::abs(columns) + std::abs(rows) + std::abs(chequer));
}

}  // namespace

void PartialExchanger::look(Cell& cell) {
    const Root& root = roots_[cell.root];
    Viewpoints points;
    std::array<double, 16> weight;
    for (std::size_t k = 0; k < 16; ++k) {
        const double s = cell.s + cell.size * nodes[k % 4], t = cell.t + cell.size * nodes[k / 4];
        points.set(k, target_.local(root.at(s, t)));
        weight[k] = root.density(s, t) * cell.size * cell.size / 16;
    }
    ViewFactors factors;
    view(target_, points, factors);
    viewpoints += 16;
    cell.found = {};
    cell.quadrant = {};
    std::array<double, 16> seen_at, hidden_at;
    for (std::size_t k = 0; k < 16; ++k) {
        const double seen = weight[k] * static_cast<double>(factors.seen[k]);
        const double hidden = weight[k] * static_cast<double>(factors.free[k] - factors.seen[k]);
        seen_at[k] = seen;
        hidden_at[k] = hidden;
        Parts& quadrant = cell.quadrant[k % 4 / 2 + k / 8 * 2];
        quadrant.seen += seen;
        quadrant.hidden += hidden;
        cell.found.seen += seen;
        cell.found.hidden += hidden;
    }
    cell.forced = is_large(cell);
    cell.unevenness = {unevenness(seen_at), unevenness(hidden_at)};
}

// Shadows vary over what is as far away as they are wide: a cell that is larger than its distance
// from an obstacle may have missed one.
bool PartialExchanger::is_large(const Cell& cell) const {
    const Root& root = roots_[cell.root];
    const auto& c = root.corners;
    const Vec3 middle = root.at(cell.s + 0.5 * cell.size, cell.t + 0.5 * cell.size);
    const double width = cell.size * std::max(length(c[2] - c[0]), length(c[3] - c[1]));
    for (const Box& box : near_) {
        const Vec3 off = middle - max(box.lower, min(middle, box.upper));
        if (dot(off, off) < 0.25 * width * width) return true;
    }
    return false;
}

// Errors of both sums: of cells that err at random, and of cells that err alike, as they do along
// the edge of a shadow that is parallel to them.
PartialExchanger::Parts PartialExchanger::errors() const {
    Parts squares, sum;
    for (const Cell& cell : cells_) {
        squares.seen += cell.change.seen * cell.change.seen;
        squares.hidden += cell.change.hidden * cell.change.hidden;
        sum.seen += cell.change.seen;
        sum.hidden += cell.change.hidden;
    }
    return {finer * (std::sqrt(squares.seen) + std::abs(sum.seen)),
            finer * (std::sqrt(squares.hidden) + std::abs(sum.hidden))};
}

PartialExchanger::Root::Root(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d,
                             const Vec3& normal)
    : corners{a, b, c, d} {
    const Vec3 ab = b - a, ad = d - a, dc = c - d, bc = c - b;
    const double at00 = dot(cross(ab, ad), normal);
    jacobian = {at00, dot(cross(ab, bc), normal) - at00, dot(cross(dc, ad), normal) - at00};
}

Vec3 PartialExchanger::Root::at(double s, double t) const {
    const Vec3 low = corners[0] + (corners[1] - corners[0]) * s;
    const Vec3 high = corners[3] + (corners[2] - corners[3]) * s;
    return low + (high - low) * t;
}

double PartialExchanger::free(std::span<const Vec3> from, const Plane& from_plane,
                              std::span<const Vec3> to, const Plane& to_plane) {
    const Root root(from[0], from[1], from[2], from[from.size() - 1], from_plane.normal);
    const Vec3 origin = centroid(to);
    target_.set(SmallPolygon(to), to_plane, from_plane.normal, {}, origin,
                1 / length(from[0] - origin));
    const auto& rule = gauss_legendre<4>();
    Viewpoints points;
    std::array<double, 16> weight;
    for (std::size_t k = 0; k < 16; ++k) {
        const double s = rule.at[k % 4], t = rule.at[k / 4];
        points.set(k, target_.local(root.at(s, t)));
        weight[k] = root.density(s, t) * rule.weight[k % 4] * rule.weight[k / 4];
    }
    ViewFactors factors;
    view(target_, points, factors);
    double sum = 0;
    for (std::size_t k = 0; k < 16; ++k) sum += weight[k] * static_cast<double>(factors.free[k]);
    return sum;
}

void PartialExchanger::split(std::size_t which) {
    const Cell parent = cells_[which];
    for (std::size_t q = 0; q < 4; ++q) {
        Cell part;
        part.root = parent.root;
        part.size = 0.5 * parent.size;
        part.s = parent.s + (q % 2 ? part.size : 0);
        part.t = parent.t + (q / 2 ? part.size : 0);
        look(part);
        part.change = {part.found.seen - parent.quadrant[q].seen,
                       part.found.hidden - parent.quadrant[q].hidden};
        if (q == 0)
            cells_[which] = part;
        else
            cells_.push_back(part);
    }
}

PartialExchange PartialExchanger::operator()(const SmallPolygon& from, const Plane& from_plane,
                                             const SmallPolygon& to, const Plane& to_plane,
                                             std::span<const Obstacle> obstacles,
                                             double tolerance) {
    const Vec3 origin = centroid(to.corners());
    double reach = 0;
    for (const Vec3& p : from.corners()) reach = std::max(reach, length(p - origin));
    target_.set(to, to_plane, from_plane.normal, obstacles, origin, 1 / reach);

    near_.assign(1, Box{});
    for (const Vec3& p : to.corners()) near_[0].add(p);
    for (const Obstacle& obstacle : obstacles) near_.push_back(obstacle.blocker->bounds);

    roots_.clear();
    cells_.clear();
    for (std::size_t k = 1; k + 1 < from.count; k += 2) {  // a fan of quadrilaterals
        const Vec3 &a = from.at[0], &b = from.at[k], &c = from.at[k + 1],
                   &d = from.at[std::min(k + 2, from.count - 1)];
        Cell whole;
        whole.root = static_cast<std::uint32_t>(roots_.size());
        roots_.emplace_back(a, b, c, d, from_plane.normal);
        look(whole);
        cells_.push_back(whole);
    }
    double free = 0;
    for (const Cell& cell : cells_) free += cell.found.seen + cell.found.hidden;
    PartialExchange result;
    // A sixth of what would be seen freely may slip between sixteen points.
    const double slips = 6 * tolerance;
    Parts uneven;
    bool forced = false;
    for (const Cell& cell : cells_) {
        uneven.seen += cell.unevenness.seen;
        uneven.hidden += cell.unevenness.hidden;
        forced = forced || cell.forced;
    }
    result.by_hidden = uneven.hidden < uneven.seen;
    // Where all points agree, of a corner as much as this may have slipped between them.
    const auto unnoticed = [&] {
        Parts sum;
        for (const Cell& cell : cells_) {
            sum.seen += cell.found.seen;
            sum.hidden += cell.found.hidden;
        }
        const double share = 0.0025 / static_cast<double>(cells_.size());
        return std::min(sum.seen, sum.hidden) < 1e-5 * free ? share * free : 0;
    };
    if (free > slips &&
        (forced || std::min(uneven.seen, uneven.hidden) > tolerance || unnoticed() > tolerance)) {
        const std::size_t whole = cells_.size();
        for (std::size_t k = 0; k < whole; ++k) split(k);
        for (std::size_t k = 0; k < cells_.size() && cells_.size() < most_cells; ++k)
            while (cells_[k].forced && cells_[k].found.seen + cells_[k].found.hidden > slips &&
                   cells_.size() < most_cells)
                split(k);
        while (unnoticed() > tolerance && cells_.size() < most_agreeing)
            split(static_cast<std::size_t>(
                std::max_element(cells_.begin(), cells_.end(),
                                 [](const Cell& a, const Cell& b) { return a.size < b.size; }) -
                cells_.begin()));
        for (;;) {
            const Parts error = errors();
            result.by_hidden = error.hidden < error.seen;
            if (std::min(error.seen, error.hidden) <= tolerance || cells_.size() >= most_cells)
                break;
            const auto change = [&](const Cell& cell) {
                return std::abs(result.by_hidden ? cell.change.hidden : cell.change.seen);
            };
            split(static_cast<std::size_t>(std::max_element(cells_.begin(), cells_.end(),
                                                            [&](const Cell& a, const Cell& b) {
                                                                return change(a) < change(b);
                                                            }) -
                                           cells_.begin()));
        }
    }
    for (const Cell& cell : cells_) {
        result.seen += cell.found.seen;
        result.hidden += cell.found.hidden;
    }
    return result;
}

}  // namespace exitance
