// SPDX-License-Identifier: Apache-2.0
// Classic radiosity from end to end: elements and their form factors, one of the solvers, and the
// light at the vertices.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "exitance/solve/element_solver.h"
#include "exitance/solve/radiosity.h"
#include "exitance/transport/column.h"

namespace exitance {

struct ElementOptions {
    std::string solver;                    ///< element_methods.h
    std::optional<std::string> transport;  ///< by default dense, sparse above 10 000 elements
    std::optional<std::string> factors;    ///< hemisphere or pairs; by default pairs of few rows
    std::optional<int> rays;               ///< per element; by default from the error
    float min_area = 0;                    ///< links divide no element below this area [m²]
    bool divide = true;                    ///< links divide elements at all
    bool gather_vertices = true;           ///< or else the mean of the elements around
    bool light_meanwhile = false;          ///< vertices too, roughly, whenever it observes
    ElementSolverOptions solving;
    ColumnOptions column;
};

/// What was done.
struct ElementReport {
    std::string transport;
    std::size_t rows = 0;
    double sweeps = 0, residual = 0;  ///< the latter by a product with the whole matrix at the end
    std::uint64_t shots = 0, rays = 0;
    std::size_t bytes = 0;  ///< of the transport
    std::optional<std::size_t> links{};
};

/// Divides light among the leaves of the mesh as it is, each with one exitance, and gives the
/// vertices irradiance: by one gathering step, or the mean of their elements. Links divide the
/// leaves first where that is needed. Interrupted, it keeps
/// what was found so far. Throws Error(wrong_use) for a dense matrix that would not fit.
ElementReport solve_elements(Radiosity& radiosity, const ElementOptions& options, const Stop& stop,
                             const Stopwatch& clock, const Observer& observe);

}  // namespace exitance
