// SPDX-License-Identifier: Apache-2.0
// Net radiation in an enclosure of grey diffuse surfaces: who gives how much heat to the others
// (the radiosity method of heat transfer; Hottel 1954, Sparrow & Cess 1966).
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exitance/formfactor/form_factor_matrix.h"

namespace exitance {

/// Stefan-Boltzmann constant [W/(m² K⁴)] (CODATA 2018).
inline constexpr double stefan_boltzmann = 5.670374419e-8;

/// What is known of a surface: its temperature, or the heat it gives.
struct ThermalSurface {
    double emissivity = 1;                ///< = absorptance (grey), 0 … 1
    std::optional<double> temperature{};  ///< [K]
    std::optional<double> heat_flux{};    ///< net heat it sends out [W/m²]; 0 = it reradiates
};

struct RadiatingSurface {
    /// [K]; nan where nothing tells it: it neither emits nor is a temperature given.
    double temperature = std::numeric_limits<double>::quiet_NaN();
    double radiosity = 0;    ///< J: what leaves it [W/m²]
    double irradiation = 0;  ///< H: what arrives [W/m²]
    double heat_flux = 0;    ///< q = J − H [W/m²]
    double heat = 0;         ///< Q = A q [W]
};

struct NetRadiation {
    std::vector<RadiatingSurface> surfaces;
    double lost = 0;       ///< to the surroundings, net [W]
    double imbalance = 0;  ///< Σ Q − lost [W]: 0 but for rounding
};

/// Largest share 1 − Σ_j F_ij of a row that sees the surroundings.
double largest_opening(const FormFactorMatrix& F);

/// Solves J_i = ε_i σ T_i⁴ + (1 − ε_i) H_i where the temperature is known and J_i = q_i + H_i where
/// the heat is, with H_i = Σ_j F_ij J_j + (1 − Σ_j F_ij) σ T_s⁴: what a row lacks it sees of
/// surroundings at `surroundings` [K]. F is symmetrised. Throws Error(bad_input) if a surface has
/// none or both, heat cannot leave it (ε = 0), the heat given drives a temperature below zero, or
/// nothing sets the level: a closed enclosure without a temperature.
NetRadiation net_radiation(const FormFactorMatrix& F, std::span<const ThermalSurface> surfaces,
                           double surroundings, const std::vector<std::string>& names);

}  // namespace exitance
