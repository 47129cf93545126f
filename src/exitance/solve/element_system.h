// SPDX-License-Identifier: Apache-2.0
// The linear system of classic radiosity, one exitance per element: B = E + ρ F B. What is emitted
// is known, so the unknown is what is reflected, R = B − E, of D + F R, where D = F E is the
// irradiance straight from the lamps and from all that is no polygon:
//
//     R = ρ (D + F R)
#pragma once

#include <vector>

#include "exitance/solve/radiosity.h"
#include "exitance/transport/transport.h"

namespace exitance {

/// Rows as the transport has them. The transport is made between D and the first sweep.
struct ElementSystem {
    Columns columns;
    std::vector<float> area;  ///< [m²]; rows without area take no part
    RowField rho;
    RowField emitted;         ///< E
    RowField direct;          ///< D
    double emitted_flux = 0;  ///< of everything, weighted by luminance

    std::size_t rows() const { return area.size(); }
};

}  // namespace exitance
