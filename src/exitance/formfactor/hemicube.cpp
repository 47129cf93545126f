// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/hemicube.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace exitance {

namespace {

// From a corner of the top or of a side, the factor of the rectangle up to (u, v), which
// differences make a cell's. Top: Howell's B-3 at distance 1. Side: B-5, u along the horizon, v
// above it.
double top_corner(double u, double v) {
    const double a = std::sqrt(1 + u * u), b = std::sqrt(1 + v * v);
    return (u / a * std::atan(v / a) + v / b * std::atan(u / b)) / (2 * std::numbers::pi);
}

double side_corner(double u, double v) {
    const double b = std::sqrt(1 + v * v);
    return (std::atan(u) - std::atan(u / b) / b) / (2 * std::numbers::pi);
}

template <class Corner>
std::vector<double> cells(std::size_t columns, std::size_t rows, double bottom, double step,
                          const Corner& corner) {
    std::vector<double> out;
    for (std::size_t j = 0; j < rows; ++j)
        for (std::size_t i = 0; i < columns; ++i) {
            const double u = -1 + static_cast<double>(i) * step,
                         v = bottom + static_cast<double>(j) * step;
            out.push_back(corner(u + step, v + step) - corner(u, v + step) - corner(u + step, v) +
                          corner(u, v));
        }
    return out;
}

// Coordinates of a point before face `face`: across, up, out. The frame's normal is up.
Vec3 turned(const Vec3& p, std::size_t face) {
    switch (face) {
        case 0:
            return {p.x, p.y, p.z};
        case 1:
            return {p.y, p.z, p.x};
        case 2:
            return {-p.y, p.z, -p.x};
        case 3:
            return {-p.x, p.z, p.y};
        default:
            return {p.x, p.z, -p.y};
    }
}

// Keeps the part of the outline where inside(p) ≥ 0, a linear function.
template <class Inside>
void clip(std::vector<Vec3>& outline, std::vector<Vec3>& clipped, const Inside& inside) {
    clipped.clear();
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vec3 &p = outline[i], &q = outline[(i + 1) % outline.size()];
        const double hp = inside(p), hq = inside(q);
        if (hp >= 0) clipped.push_back(p);
        if ((hp > 0 && hq < 0) || (hp < 0 && hq > 0))
            clipped.push_back(p + (q - p) * (hp / (hp - hq)));
    }
    outline.swap(clipped);
}

}  // namespace

Hemicube::Hemicube(std::size_t resolution) : resolution_(resolution) {
    const double step = 2.0 / static_cast<double>(resolution);
    top_ = cells(resolution, resolution, -1, step, top_corner);
    side_ = cells(resolution, resolution / 2, 0, step, side_corner);
    item_.resize(3 * resolution * resolution);
    nearness_.resize(item_.size());
}

void Hemicube::look(const Vec3& eye, const Frame& frame, const Enclosure& enclosure,
                    std::span<const BlockingFacet> blockers) {
    std::fill(item_.begin(), item_.end(), BlockingFacet::none);
    std::fill(nearness_.begin(), nearness_.end(), 0.0f);
    std::array<Vec3, 4> local;
    for (const BlockingFacet& blocker : blockers) {
        const Facet& facet = enclosure.facets[blocker.front];
        const double height = dot(eye - facet.outline[0], facet.normal);
        bool above = false;
        for (std::size_t i = 0; i < facet.count; ++i) {
            const Vec3 p = facet.outline[i] - eye;
            local[i] = {dot(p, frame.tangent), dot(p, frame.bitangent), dot(p, frame.normal)};
            above |= local[i].z > 0;
        }
        // Below the horizon, or seen edge on.
        if (!above || std::abs(height) <= 1e-9 * std::sqrt(facet.area)) continue;
        std::uint32_t item = height > 0 ? blocker.front : blocker.back;
        if (item != BlockingFacet::none && enclosure.facets[item].row == Facet::only_blocks)
            item = BlockingFacet::none;
        for (std::size_t face = 0; face < 5; ++face)
            draw(std::span(local.data(), facet.count), face, item);
    }
}

void Hemicube::draw(std::span<const Vec3> corners, std::size_t face, std::uint32_t item) {
    std::vector<Vec3> outline, spare;
    for (const Vec3& c : corners) outline.push_back(turned(c, face));
    const auto all = [&](const auto& outside) {
        return std::all_of(outline.begin(), outline.end(), outside);
    };
    if (all([](const Vec3& p) { return p.x > p.z; }) ||
        all([](const Vec3& p) { return -p.x > p.z; }) ||
        all([](const Vec3& p) { return p.y > p.z; }) ||
        all([&](const Vec3& p) { return face == 0 ? -p.y > p.z : p.y < 0; }))
        return;
    // Plane p · n = d, from the whole polygon: 1 / depth is linear in the picture.
    const Vec3 n = cross(outline[1] - outline[0], outline[2] - outline[0]);
    const double d = dot(n, outline[0]);
    if (d == 0) return;
    clip(outline, spare, [](const Vec3& p) { return p.z - p.x; });
    clip(outline, spare, [](const Vec3& p) { return p.z + p.x; });
    clip(outline, spare, [](const Vec3& p) { return p.z - p.y; });
    clip(outline, spare, [&](const Vec3& p) { return face == 0 ? p.z + p.y : p.y; });
    outline.erase(
        std::remove_if(outline.begin(), outline.end(), [](const Vec3& p) { return !(p.z > 0); }),
        outline.end());
    if (outline.size() >= 3) fill(outline, n / d, face, item);
}

void Hemicube::fill(std::span<const Vec3> outline, const Vec3& plane, std::size_t face,
                    std::uint32_t item) {
    const double half = 0.5 * static_cast<double>(resolution_);
    const std::size_t rows = face == 0 ? resolution_ : resolution_ / 2;
    const double bottom = face == 0 ? -1 : 0;
    struct Corner {
        double x, y;  // in cells
    };
    std::array<Corner, 8> at{};
    const std::size_t count = std::min<std::size_t>(outline.size(), at.size());
    double lowest = INFINITY, highest = -INFINITY;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3& p = outline[i];
        at[i] = {(p.x / p.z + 1) * half, (p.y / p.z - bottom) * half};
        lowest = std::min(lowest, at[i].y);
        highest = std::max(highest, at[i].y);
    }
    // A cell belongs to what covers its middle.
    const auto first_middle = [](double from, std::size_t most) {
        return static_cast<std::size_t>(
            std::clamp(std::ceil(from - 0.5), 0.0, static_cast<double>(most)));
    };
    const std::size_t base =
        face == 0 ? 0 : resolution_ * resolution_ * (face + 1) / 2;  // sides are half as large
    const std::size_t end_row = first_middle(highest, rows);
    for (std::size_t row = first_middle(lowest, rows); row < end_row; ++row) {
        const double y = static_cast<double>(row) + 0.5;
        double left = INFINITY, right = -INFINITY;
        for (std::size_t i = 0; i < count; ++i) {
            const Corner &a = at[i], &b = at[(i + 1) % count];
            if ((a.y <= y) == (b.y <= y)) continue;
            const double x = a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
            left = std::min(left, x);
            right = std::max(right, x);
        }
        if (!(left < right)) continue;
        const double v = bottom + y / half;
        const double start = plane.y * v + plane.z;
        const std::size_t end = first_middle(right, resolution_);
        for (std::size_t column = first_middle(left, resolution_); column < end; ++column) {
            const double u = (static_cast<double>(column) + 0.5) / half - 1;
            const auto near = static_cast<float>(plane.x * u + start);
            const std::size_t cell = base + row * resolution_ + column;
            if (near <= nearness_[cell]) continue;
            nearness_[cell] = near;
            item_[cell] = item;
        }
    }
}

}  // namespace exitance
