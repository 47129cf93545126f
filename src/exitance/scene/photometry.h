// SPDX-License-Identifier: Apache-2.0
// How much light a luminaire sends where, seen from afar: luminous intensity over directions, in
// the C-planes of CIE 121 (type C of IES LM-63).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exitance/math/vector.h"
#include "exitance/scene/luminous_opening.h"

namespace exitance {

/// What a distribution looks the same under.
enum class LampSymmetry {
    none,
    about_c0,   ///< mirrored in the plane C0–C180
    about_c90,  ///< mirrored in the plane C90–C270
    both,       ///< mirrored in both
    rotational
};

/// Light output of a lamp against the tilt of its luminaire (TILT of IES LM-63).
struct LampTilt {
    std::vector<double> angles;   ///< increasing [degrees]
    std::vector<double> factors;  ///< of the light output
    /// Interpolated, constant beyond the ends.
    double factor(double degrees) const;
};

/// Intensities in candela, bilinear in the angles. A direction is (C, γ): γ from 0 (nadir) to 180°
/// (zenith), C round the vertical axis, counter-clockwise seen from above. In the photometric frame
/// x = C0, y = C90, z = zenith it is (sin γ cos C, sin γ sin C, −cos γ).
struct Photometry {
    std::vector<double> planes;   ///< C [degrees], increasing from 0 to 360; one 0 if rotational
    std::vector<double> gammas;   ///< γ [degrees], increasing, at least two; dark beyond them
    std::vector<double> candela;  ///< planes × gammas, row C; the rows of 0 and 360 agree

    LuminousOpening opening;
    std::optional<Vec3> housing;  ///< size of the luminaire along C0, C90, up, where told [m]

    /// Where the measurement's own zero lies, which is what aiming turns to the target: nadir, but
    /// C0 for the type A of vehicle lamps.
    Vec3 forward{0, 0, -1};

    bool absolute = false;              ///< measured as a whole, not relative to bare lamps
    std::optional<double> lamp_lumens;  ///< of all lamps together [lm]; none if absolute
    std::optional<double> watts;        ///< input power [W]
    std::optional<double> stated_lor;   ///< light output ratio as the file says, 0 … 1
    LampTilt tilt{};                    ///< empty: the position does not matter

    std::string name, maker, catalogue, lamp;  ///< as the file says, UTF-8

    /// Intensity along `direction`, unit, in the photometric frame [cd].
    double intensity(const Vec3& direction) const;
    /// Intensity at angles in degrees; any C, γ from 0 to 180 [cd].
    double at(double c, double gamma) const;
    /// Φ = ∫ I dω of the interpolated table, without discretisation error [lm].
    double flux() const;
    /// The part of it below the horizontal, γ < 90° [lm].
    double flux_below() const;
};

/// Directions of the photometric frame in proportion to the light that takes them.
class DirectionSampler {
  public:
    explicit DirectionSampler(const Photometry& photometry);

    struct Sample {
        Vec3 direction;     ///< unit
        double weight = 0;  ///< I / (Φ · density), 1 on average
    };
    /// From three numbers in [0, 1); weight 0 if the luminaire is dark.
    Sample sample(double cell, double u, double v) const;

  private:
    const Photometry* photometry_;
    std::vector<double> cumulative_;  ///< of the flux in cells planes × gammas
};

}  // namespace exitance
