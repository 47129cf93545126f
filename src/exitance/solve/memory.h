// SPDX-License-Identifier: Apache-2.0
// What a solve by gathering takes of memory, counted ahead: not measured, so that the same limit
// leads to the same solution everywhere.
#pragma once

#include <cstddef>
#include <cstdint>

#include "exitance/solve/radiosity.h"

namespace exitance {

class MemoryPlan {
  public:
    /// Of a mesh of undivided patches. `limit`: of the whole process [bytes]; `besides`: what its
    /// owner holds all the time, as a solution to go on from. Throws Error(could_not_finish) that
    /// says how much is needed if there is no solution that fits.
    MemoryPlan(const Radiosity& radiosity, double limit, double besides);

    /// The mesh may grow so far.
    std::size_t most_vertices() const { return most_vertices_; }
    /// For direct light, which comes first; the rest is for what is reflected.
    std::size_t most_vertices_of_direct() const { return most_vertices_of_direct_; }
    std::size_t most_cell_bytes() const { return most_cell_bytes_; }
    /// As many rays per patch as are wanted, or as their hits can be kept; a power of two.
    std::uint32_t patch_rays(std::uint32_t wanted, std::size_t vertices) const;

  private:
    double mesh_bytes(double vertices) const;
    double need(double vertices) const;
    double need_of_balance(double vertices, double rays) const;

    double limit_, begin_vertices_, fixed_, patches_, stride_, triangular_;
    std::size_t most_vertices_ = 0, most_vertices_of_direct_ = 0, most_cell_bytes_ = 0;
};

/// Throws Error(could_not_finish) if not even the polygons and patches of `patch_size` [m] fit,
/// before they are made.
void require_memory(const Scene& scene, double patch_size, double limit);

}  // namespace exitance
