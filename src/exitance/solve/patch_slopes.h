// SPDX-License-Identifier: Apache-2.0
// How what patches receive goes on inside them: linearly, as their neighbours tell.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/mesh/field.h"
#include "exitance/mesh/mesh.h"

namespace exitance {

class PatchSlopes {
  public:
    /// Patches with no open area [m²] are nobody's neighbours. `mesh` outlives this.
    PatchSlopes(const Mesh& mesh, std::span<const float> open_area);

    /// How values, one row per patch, rise from one end of the patch to the other along the side
    /// that leaves its first corner (s) and along the one that arrives there (t): by least squares
    /// from the patches beside it on the same smooth surface. None becomes negative anywhere.
    void find(PatchId patch, const RowField& values, std::span<float> s, std::span<float> t) const;

  private:
    struct Neighbour {
        std::uint32_t patch;
        float s, t;  ///< from middle to middle, in sides of the patch whose neighbour it is
    };
    void meet(PatchId patch, PatchId other);

    const Mesh& mesh_;
    std::vector<std::array<Neighbour, 4>> beside_;
    std::vector<std::uint8_t> count_;
};

}  // namespace exitance
