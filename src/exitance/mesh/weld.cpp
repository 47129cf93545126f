// SPDX-License-Identifier: Apache-2.0
#include "exitance/mesh/weld.h"

#include <algorithm>
#include <cmath>

namespace exitance {

namespace {

// Corners closer than this share of the scene's diagonal are one place: what transforms in float
// leave of coordinates that were meant to be equal.
constexpr double weld_tolerance = 1e-7;

}  // namespace

Welder::Welder(const Box& bounds, std::vector<Vec3>& positions)
    : positions_(positions),
      lower_(bounds.lower),
      cell_(std::max(bounds.diagonal() * weld_tolerance, 1e-300)) {}

Welder::Cell Welder::cell_of(const Vec3& p) const {
    const auto coordinate = [&](double x, double low) {
        return static_cast<std::int64_t>(std::floor((x - low) / cell_));
    };
    return {coordinate(p.x, lower_.x), coordinate(p.y, lower_.y), coordinate(p.z, lower_.z)};
}

PositionId Welder::at(const Vec3& point) {
    const auto [same, fresh] = exact_.insert({point, PositionId(positions_.size())});
    if (!fresh) return same->second;
    PositionId match{};
    const Cell middle = cell_of(point);
    for (int n = 0; n < 27 && !match.valid(); ++n) {
        // The middle cell first.
        const int m = (n + 13) % 27;
        const auto found =
            cells_.find({middle.x + m % 3 - 1, middle.y + m / 3 % 3 - 1, middle.z + m / 9 - 1});
        if (found != cells_.end() && length(positions_[found->second.index()] - point) < cell_)
            match = found->second;
    }
    if (!match.valid()) {
        match = PositionId(positions_.size());
        positions_.push_back(point);
        cells_.insert({middle, match});
    }
    same.value() = match;
    return match;
}

}  // namespace exitance
