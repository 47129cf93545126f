// SPDX-License-Identifier: Apache-2.0
// Luminaires made by hand.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>

#include "exitance/scene/luminaire.h"

namespace exitance::testing {

/// `candela` · cos γ below the horizontal, in steps of a tenth of a degree: linear interpolation
/// errs by h²/8 = 4e-7 of the peak at most.
inline Photometry cosine_photometry(double candela, const LuminousOpening& opening = {}) {
    Photometry p;
    p.planes = {0};
    p.opening = opening;
    for (int i = 0; i <= 900; ++i) {
        p.gammas.push_back(0.1 * i);
        p.candela.push_back(candela * std::cos(0.1 * i * std::numbers::pi / 180));
    }
    p.candela.back() = 0;
    return p;
}

/// Different in every direction, brightest at C60 γ 40, up to γ = 150.
inline Photometry crooked_photometry(const LuminousOpening& opening = {}) {
    Photometry p;
    p.opening = opening;
    for (double c = 0; c <= 360; c += 20) p.planes.push_back(c);
    for (double gamma = 0; gamma <= 150; gamma += 10) p.gammas.push_back(gamma);
    for (const double c : p.planes)
        for (const double gamma : p.gammas) {
            const double g = gamma * std::numbers::pi / 180, a = (c - 60) * std::numbers::pi / 180;
            p.candela.push_back(200 * (1 + std::cos(g - 0.7)) * (1.2 + std::sin(g) * std::cos(a)) *
                                (gamma < 150 ? 1 : 0));
        }
    return p;
}

/// Looking to −z, C0 along +x.
inline Luminaire hanging(Photometry photometry, const Vec3& position, double multiplier = 1) {
    Luminaire out;
    out.name = "lamp";
    out.photometry = std::make_shared<const Photometry>(std::move(photometry));
    out.position = position;
    out.c0 = {1, 0, 0};
    out.nadir = {0, 0, -1};
    out.multiplier = multiplier;
    return out;
}

inline LuminousOpening opening(LuminousOpening::Shape shape, const Vec3& size,
                               std::uint32_t axis = 2) {
    LuminousOpening out;
    out.shape = shape;
    out.size = size;
    out.axis = axis;
    return out;
}

/// One of every kind.
inline std::vector<LuminousOpening> all_openings() {
    using Shape = LuminousOpening::Shape;
    LuminousOpening sides = opening(Shape::box, {0.3, 1.2, 0.08});
    sides.sides_shine = false;
    sides.sides = {0.08, 0, 0.05, 0};
    return {{},
            opening(Shape::box, {0, 1.2, 0}),
            opening(Shape::box, {0.6, 0.3, 0}),
            opening(Shape::box, {0.2, 0.3, 0.4}),
            sides,
            opening(Shape::cylinder, {0.4, 0.4, 0}),
            opening(Shape::cylinder, {0.2, 0.3, 0.5}),
            opening(Shape::cylinder, {1.0, 0.1, 0.1}, 0),
            opening(Shape::cylinder, {0.1, 1.0, 0.1}, 1),
            opening(Shape::ellipsoid, {0.3, 0.4, 0.2})};
}

}  // namespace exitance::testing
