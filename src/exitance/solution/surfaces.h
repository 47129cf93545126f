// SPDX-License-Identifier: Apache-2.0
// The triangles of a solution made ready for rays: who is hit, and what light is there.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/solution/solution.h"
#include "exitance/visibility/ray_caster.h"

namespace exitance {

/// What a ray meets at the back of a triangle.
enum class Backs {
    black,  ///< one-sided surfaces block and send nothing; two-sided ones show their other side
    open    ///< the ray goes on, as pictures show a room from outside
};

/// A place on a triangle: weights of its three corners, which sum to 1.
struct SurfacePlace {
    std::uint32_t triangle = 0;
    std::array<double, 3> weights{};
};

class Surfaces {
  public:
    /// `solution` must outlive this. Throws Error(could_not_finish) when memory runs out.
    Surfaces(const Solution& solution, Backs backs);

    const Solution& solution() const { return *solution_; }
    const RayCaster& caster() const { return caster_; }
    /// Length of the diagonal of the bounding box [m].
    double diagonal() const { return diagonal_; }

    const SolutionPart& part(std::uint32_t triangle) const {
        return solution_->parts[part_of_triangle_[triangle]];
    }
    std::array<Vec3, 3> corners(std::uint32_t triangle) const;

    /// Where coordinates (u, v) of a ray hit lie.
    static SurfacePlace place(std::uint32_t triangle, float u, float v) {
        return {triangle, {1.0 - double(u) - double(v), double(u), double(v)}};
    }
    /// Irradiance at a place, interpolated between the corners, per column [irradiance_unit].
    void irradiance(const SurfacePlace& place, std::span<double> columns) const;

    /// Values of a pattern at one place: R, G, B.
    using PatternHere = std::array<double, 3>;
    /// Diffuse reflectance per band at a place, in full resolution; `room` may hold it.
    std::span<const double> reflectance(const SurfacePlace& place, PatternHere& room) const;
    /// Emitted exitance per band, the same way [exitance_unit].
    std::span<const double> emission(const SurfacePlace& place, PatternHere& room) const;

  private:
    std::span<const double> evaluate(const Pattern& pattern, const Spectrum& even,
                                     TexturePoint TextureCoordinates::*which,
                                     const SurfacePlace& place, PatternHere& room) const;

    const Solution* solution_;
    std::vector<std::uint32_t> part_of_triangle_;
    double diagonal_;
    RayCaster caster_;
};

}  // namespace exitance
