// SPDX-License-Identifier: Apache-2.0
// A lamp in its place: emission without geometry.
#pragma once

#include <memory>
#include <string>

#include "exitance/run/error.h"
#include "exitance/scene/photometry.h"
#include "exitance/scene/spectrum.h"

namespace exitance {

struct Luminaire {
    std::string name;
    std::shared_ptr<const Photometry> photometry;
    Vec3 position;                      ///< of the photometric centre [m]
    Vec3 c0{1, 0, 0}, nadir{0, -1, 0};  ///< where C0 and γ = 0 point; unit, perpendicular
    double multiplier = 1;              ///< of the photometry: lumens, dimming, maintenance …
    Spectrum colour{1.0, 1.0, 1.0};     ///< per band, of luminance 1
    std::string group;                  ///< light group; "" = chosen by --groups
    Place place;                        ///< where it was declared

    /// A direction of the world in the photometric frame, and back.
    Vec3 to_photometric(const Vec3& direction) const;
    Vec3 to_world(const Vec3& direction) const;

    /// Luminous intensity along `direction`, unit, in the world [cd, or W/sr in a radiometric
    /// scene].
    double intensity(const Vec3& direction) const;
    /// Flux that leaves it [flux_unit].
    double flux() const;
};

}  // namespace exitance
