// SPDX-License-Identifier: Apache-2.0
// A photometric file in use: what is accepted must have sound figures and shine.
#pragma once

#include <cmath>
#include <cstdlib>
#include <memory>
#include <utility>

#include "exitance/scene/formats/lamp_file.h"
#include "exitance/scene/lamp_figures.h"

namespace exitance::fuzz {

inline Scene lamp_scene(LampFile file) {
    const LampFigures figures = figures_of(file.photometry);
    if (!(figures.flux >= 0) || !std::isfinite(figures.flux)) std::abort();
    const DirectionSampler sampler(file.photometry);
    for (const double at : {0.0, 0.3, 0.99}) {
        const auto sample = sampler.sample(at, 0.5, at);
        if (!(sample.weight >= 0) || !std::isfinite(sample.weight)) std::abort();
    }
    for (const OpeningFacet& facet : facets(file.photometry.opening))
        if (!(facet.area > 0)) std::abort();
    Scene scene;
    Luminaire luminaire;
    luminaire.photometry = std::make_shared<const Photometry>(std::move(file.photometry));
    for (const Vec3& d : {Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0.6, 0.8}})
        if (!(luminaire.intensity(d) >= 0)) std::abort();
    scene.luminaires.push_back(std::move(luminaire));
    return scene;
}

}  // namespace exitance::fuzz
