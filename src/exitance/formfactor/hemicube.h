// SPDX-License-Identifier: Apache-2.0
// The hemicube (Cohen & Greenberg 1985, "The hemi-cube: a radiosity solution for complex
// environments"): everything a place sees is projected onto the five faces of half a cube around
// it; each cell of a face holds the item that is nearest there and carries a delta form factor that
// is computed beforehand.
#pragma once

#include <vector>

#include "exitance/formfactor/facet_caster.h"
#include "exitance/formfactor/method.h"
#include "exitance/math/frame.h"

namespace exitance {

/// The item buffer and delta form factors of one resolution.
class Hemicube {
  public:
    /// `resolution` cells along the edge of the top, even; the sides are half as high.
    explicit Hemicube(std::size_t resolution);

    /// Draws what is seen from `eye` in the directions of `frame`; what is drawn before is gone.
    void look(const Vec3& eye, const Frame& frame, const Enclosure& enclosure,
              std::span<const BlockingFacet> blockers);

    /// Calls visit(facet, delta form factor) for every cell in which a facet shows its front.
    template <class Visit>
    void visit_cells(const Visit& visit) const {
        for (std::size_t c = 0; c < item_.size(); ++c)
            if (item_[c] != BlockingFacet::none) visit(item_[c], delta(c));
    }

    /// Over all cells it is 1: the factors are the exact ones of the cells' rectangles, where the
    /// original has them at the cells' middles times their area.
    double delta(std::size_t cell) const {
        const std::size_t top = resolution_ * resolution_, side = top / 2;
        return cell < top ? top_[cell] : side_[(cell - top) % side];
    }

  private:
    void draw(std::span<const Vec3> corners, std::size_t face, std::uint32_t item);
    void fill(std::span<const Vec3> outline, const Vec3& plane, std::size_t face,
              std::uint32_t item);

    std::size_t resolution_;
    std::vector<double> top_, side_;
    std::vector<std::uint32_t> item_;  ///< top, then the four sides
    std::vector<float> nearness_;      ///< 1 / depth
};

/// Hemicubes stand in the middle of cells of a facet: 4, 16, 64 until that changes no factor by
/// more than the accuracy; `samples` sets their number, to the next square. `resolution` is
/// 4 / √accuracy if it is not set, between 32 and 1024.
FormFactorMatrix hemicube_form_factors(const MethodCall& call);

}  // namespace exitance
