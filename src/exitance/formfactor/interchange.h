// SPDX-License-Identifier: Apache-2.0
// Total interchange factors (Hottel's script-F): what one grey surface's emission leaves in another
// by all reflections together.
#pragma once

#include <span>

#include "exitance/formfactor/enclosure.h"
#include "exitance/formfactor/form_factor_matrix.h"

namespace exitance {

/// 𝓕_ij with A_i 𝓕_ij σ (T_i⁴ − T_j⁴) the net radiation from i to j, by Gebhart's method (1961):
/// A 𝓕 = A ε (A − S ρ)⁻¹ S ε, with S = A F symmetrised, ρ = 1 − ε. In a closed enclosure row i adds
/// up to ε_i. Dense: memory for two n × n matrices of doubles. Throws Error(bad_input) if no light
/// is ever lost (ε = 0 everywhere, closed).
FormFactorMatrix interchange_factors(const FormFactorMatrix& F,
                                     std::span<const ExchangeSurface> surfaces);

}  // namespace exitance
