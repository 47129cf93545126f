// SPDX-License-Identifier: Apache-2.0
// Places that reflect far more than the rest, for points to look at: rays over the hemisphere
// seldom meet them, and too much of the light hangs on those that do.
#pragma once

#include <cstdint>
#include <vector>

#include "exitance/solution/surfaces.h"

namespace exitance {

class BrightTriangles {
  public:
    /// Those of `surfaces` with eight times the mean exitance or more, if they hold a fifth of its
    /// mean square at least; else none.
    explicit BrightTriangles(const Surfaces& surfaces);

    bool empty() const { return triangles_.empty(); }

    struct Sample {
        SurfacePlace at;
        Vec3 place, normal;
        double density = 0;  ///< [1/m²]
    };
    /// A place in proportion to what triangles reflect, from three numbers in [0, 1).
    Sample sample(double pick, double u, double v) const;
    /// Of such places on a triangle [1/m²].
    double density(std::uint32_t triangle) const {
        return density_.empty() ? 0.0 : double(density_[triangle]);
    }

  private:
    const Surfaces& surfaces_;
    std::vector<std::uint32_t> triangles_;
    std::vector<double> cumulative_;
    std::vector<float> density_;  ///< per triangle of the solution
};

}  // namespace exitance
