// SPDX-License-Identifier: Apache-2.0
// The exact answers and the brute-force path tracer judge each other.
#include <gtest/gtest.h>

#include <cmath>

#include "analytic/scenes.h"
#include "truth/path_tracer.h"

namespace exitance::analytic {
namespace {

TEST(TruthMeetsClosedForms, EveryCase) {
    for (const Case& c : closed_form_cases()) {
        std::vector<truth::Receiver> receivers;
        for (const Probe& probe : c.probes) receivers.push_back({probe.position, probe.normal});
        const truth::Estimate e = truth::PathTracer(c.scene).irradiance(receivers, {256, 16, 1});
        // A tenth of a percent beyond five standard errors, for float geometry; the facets of the
        // sphere are the one case whose answer is not exact for its polygons.
        const double room = c.name == "sphere_interior" ? c.tolerance : 1e-3;
        for (std::size_t p = 0; p < c.probes.size(); ++p)
            for (std::size_t b = 0; b < 3; ++b) {
                const double exact = c.probes[p].irradiance[b];
                EXPECT_NEAR(e.at(p, b), exact, 5 * e.error_at(p, b) + room * exact)
                    << c.name << ", probe " << p << ", band " << b;
                EXPECT_LE(e.error_at(p, b), 0.03 * exact + 1e-6) << c.name << ", probe " << p;
            }
    }
}

}  // namespace
}  // namespace exitance::analytic
