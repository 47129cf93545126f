// SPDX-License-Identifier: Apache-2.0
// Scenes whose light is known in closed form. A solver or form-factor method that is added to the
// project is added to the list in solvers_meet_closed_forms.cpp and meets them all.
#pragma once

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "exitance/scene/scene.h"

namespace exitance::analytic {

/// Exact irradiance at a point of a surface, per band.
struct Probe {
    Vec3 position, normal;
    Spectrum irradiance;
};

/// Exact irradiance per band at a point of a surface; nothing where an object stands on it.
using ExactLight = std::function<std::optional<Spectrum>(const Vec3& at, const Vec3& normal)>;

struct Case {
    std::string name;
    Scene scene;
    ExactLight exact;  ///< anywhere on what receives light and does not only emit
    std::vector<Probe> probes{};
    /// Allowed departure of every probe, as a share of the largest exact irradiance of the band.
    double tolerance = 0.01;
    /// What is asked of the solver, and what its energy balance must close to then. Both are
    /// looser where sources are partly hidden, because visibility is sampled.
    double error = 0.01, imbalance = 1e-3;
    /// Of elements that are not divided at shadows [m]; by default what follows from the error.
    std::optional<double> even_element_size{};
    /// RMS over mean by which the light of the scene's polygons departs from the closed form.
    double departure = 0;
    std::string why{};  ///< where the answer comes from and what the tolerance leaves room for

    void add_probe(const Vec3& at, const Vec3& normal) {
        probes.push_back({at, normal, exact(at, normal).value()});
    }
};

/// Its name, for test messages.
void PrintTo(const Case& c, std::ostream* out);

std::vector<Case> closed_form_cases();

}  // namespace exitance::analytic
