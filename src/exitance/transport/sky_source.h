// SPDX-License-Identifier: Apache-2.0
// The sky as points receive light from it: a hierarchy of cells of directions. The cells of one
// level have equal solid angles, and each knows J = ∫ L ω dω per band, so that a receiver whose
// horizon does not cut it gets n · J if nothing is in the way.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/scene/distant_light.h"

namespace exitance {

class SkySource {
  public:
    /// Cells are numbered along each hemisphere's quadtree: those below cell i of one level are
    /// 4i … 4i + 3 of the next. The finest level is 6 for a model, that of the map for a map.
    explicit SkySource(const DistantLight& light);

    static constexpr std::uint32_t coarsest = 3;  ///< 64 cells a hemisphere, as Tregenza's 145

    struct Cell {
        std::uint32_t level = 0;
        std::uint32_t index = 0;  ///< within its level, the lower hemisphere's after the upper's
        double u = 0, v = 0;      ///< corner in the square of its hemisphere
        bool lower = false;
        double size() const { return 1.0 / double(1u << level); }
        Cell child(std::uint32_t k) const;
        /// Unit vector through place (s, t) in [0, 1)² of the cell.
        Vec3 direction(double s, double t) const;
    };
    /// The cells of level 0 that shine: one a hemisphere.
    std::vector<Cell> roots() const;

    std::uint32_t finest() const { return finest_; }
    /// ∫ L ω dω weighted by luminance. Below the finest level, an even share of that.
    Vec3 vector(const Cell& cell) const;
    /// The same of one band.
    Vec3 vector(const Cell& cell, std::size_t band) const;
    std::size_t bands() const { return bands_; }
    /// Bounds of its directions: all within `angle` of `axis`.
    struct Cone {
        Vec3 axis;
        double sine = 0;  ///< of the angle
    };
    Cone cone(const Cell& cell) const;

    /// Irradiance facing `normal` if nothing is in the way, luminance-weighted.
    double irradiance(const Vec3& normal) const;

    const DistantLight& light() const { return light_; }

  private:
    struct Node {
        Vec3 luminance, axis;
        double sine = 1;
    };
    std::size_t at(const Cell& cell) const;

    DistantLight light_;
    std::size_t bands_;
    std::uint32_t finest_;
    std::vector<std::size_t> first_;  ///< of each level
    std::vector<Node> nodes_;
    std::vector<Vec3> vectors_;  ///< nodes × bands
};

}  // namespace exitance
