// SPDX-License-Identifier: Apache-2.0
// Light from infinity: the sun, the sky, an environment map.
#pragma once

#include <memory>
#include <string>

#include "exitance/run/error.h"
#include "exitance/scene/sky.h"
#include "exitance/scene/spectrum.h"

namespace exitance {

struct DistantLight {
    enum class Kind {
        disc,  ///< the sun, or one exact direction
        sky    ///< all directions
    };
    std::string name;
    Kind kind = Kind::disc;
    Spectrum colour{1.0, 1.0, 1.0};  ///< per band, of luminance 1
    std::string group;               ///< light group; "" = chosen by --groups
    Place place;                     ///< where it was declared

    // A disc:
    Vec3 direction{0, 1, 0};  ///< unit, towards the light
    double diameter = 0;      ///< full angle [rad]; 0: exactly one direction
    double irradiance = 0;    ///< on a plane across it [irradiance_unit]

    // A sky:
    SkyModel model{};
    double ground = 0;                         ///< luminance below the horizon [cd/m², W/(m² sr)]
    std::shared_ptr<const RadianceMap> map{};  ///< instead of the model
    double strength = 1;                       ///< factor of model, ground and map

    /// Radiance of a sky along the unit vector `along`, per band.
    Spectrum radiance(const Vec3& along) const;
    /// Does it shine at all?
    bool shines() const;
};

/// Irradiance of a horizontal plane under an open sky, luminance-weighted, without what is below
/// the horizon [irradiance_unit].
double horizontal_irradiance(const DistantLight& light);

}  // namespace exitance
