// SPDX-License-Identifier: Apache-2.0
// Axis-aligned bounding box; empty until a point is added.
#pragma once

#include <limits>

#include "exitance/math/vector.h"

namespace exitance {

struct Box {
    Vec3 lower{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
               std::numeric_limits<double>::infinity()};
    Vec3 upper{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
               -std::numeric_limits<double>::infinity()};

    bool empty() const { return !(lower.x <= upper.x); }
    void add(const Vec3& p) {
        lower = min(lower, p);
        upper = max(upper, p);
    }
    Vec3 centre() const { return (lower + upper) * 0.5; }
    Vec3 size() const { return empty() ? Vec3{} : upper - lower; }
    double diagonal() const { return length(size()); }
};

}  // namespace exitance
