// SPDX-License-Identifier: Apache-2.0
// What patches reflect, R = ρ (D + F R), in cells inside them: D as fine as the mesh, F R linear.
// What is far brighter than the rest can be taken out of the cells, to be lamps: rays into all
// directions would seldom meet it, and too much of the light would hang on those that do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/mesh/field.h"
#include "exitance/solve/lamps.h"
#include "exitance/solve/patch_slopes.h"
#include "exitance/solve/radiosity.h"

namespace exitance {

class PatchCells {
  public:
    /// Of the patches with these roots. They take no more than `most_bytes`: where rows are long,
    /// for many groups of light, cells would. All arguments outlive this.
    PatchCells(Radiosity& radiosity, std::span<const ElementId> roots, const PatchSlopes& slopes,
               std::size_t most_bytes);

    /// Divides patches as finely as light in them asks for. `received`: F R of patches, no rows if
    /// it is not known.
    void divide(const RowField& received);
    /// R from D of the vertices, and from F R of the patches if that is known. `shot` of the
    /// elements becomes R, too.
    void fill(const RowField& received);

    /// R per column at (u, v) of a patch, Embree's coordinates on its root.
    const float* exitance(std::uint32_t patch, float u, float v) const;
    bool is_even(std::uint32_t patch) const { return cells_[patch].steps == 1; }

    /// Takes away what is far brighter than the mean, if there is much of it: cells are dark there
    /// until the next fill(). The lamps' rows stay until then, too.
    std::vector<Lamps::Placed> take_brightest();
    /// Luminance that was taken from a patch, and from the square of it; means over the patch.
    std::array<float, 2> taken_from(std::uint32_t patch) const;

    std::size_t bytes() const;

  private:
    /// Cells of equal steps along a patch's two sides; in a triangle each is two triangles.
    struct Cells {
        std::uint32_t first = 0;  ///< row of `exitance_`
        std::uint32_t steps = 1;
        bool triangle = false;

        std::size_t count() const { return std::size_t{steps} * steps * (triangle ? 2 : 1); }
        std::size_t at(float x, float y) const;
        template <class Visit>
        void visit_those_of(const Element& leaf, const Element& root, const Visit& visit) const;
        /// `visit(cell, outline)`, in the patch's coordinates, three or four corners.
        template <class Visit>
        void visit_outlines(const Visit& visit) const;
    };
    struct Bright {
        std::uint32_t patch, cell;
        std::array<Vec3, 4> corners;
        std::uint32_t count = 4;
        float level = 0, area = 0;
    };
    void find_slopes(const Element& leaf, std::span<float> s, std::span<float> t) const;
    std::vector<Bright> brighter_than(float level) const;

    Radiosity& radiosity_;
    std::span<const ElementId> roots_;
    const PatchSlopes& slopes_;
    std::size_t most_bytes_;
    std::vector<Cells> cells_;
    std::vector<float> exitance_;
    std::vector<float> taken_;                      ///< rows of lamps
    std::vector<std::array<float, 2>> taken_from_;  ///< per patch, or empty
};

}  // namespace exitance
