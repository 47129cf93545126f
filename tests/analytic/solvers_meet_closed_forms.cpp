// SPDX-License-Identifier: Apache-2.0
// Every solver meets every scene whose light is known exactly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "analytic/scenes.h"
#include "exitance/pipeline.h"
#include "exitance/solution/surface_probe.h"
#include "exitance/solution/surfaces.h"
#include "exitance/solve/element_methods.h"

namespace exitance::analytic {
namespace {

struct Method {
    std::string name;
    SolveOptions options;
    /// Elements that are even and of one exitance each need many more to be as right as ones
    /// divided at shadows: these are asked for `less` of an error, and forgiven as much.
    double less = 1;
};

/// Adaptive shooting and gathering, and every solver of elements with every transport that it
/// bears: a new one is added to solve/element_methods.h and meets them all.
std::vector<Method> methods() {
    Method shooting;
    shooting.name = "shooting";
    shooting.options.overshoot = false;
    Method overshooting = shooting;
    overshooting.name = "overshooting";
    overshooting.options.overshoot = true;
    Method gathering;
    gathering.name = "gathering";
    gathering.options.solver = adaptive_gathering;
    std::vector<Method> all{shooting, overshooting, gathering};
    for (const ElementMethod& method : element_methods())
        for (const std::string_view transport : transports) {
            if (!go_together(method, transport)) continue;
            Method by_elements{std::string(method.name) + "_" + std::string(transport), {}, 4};
            std::replace(by_elements.name.begin(), by_elements.name.end(), '-', '_');
            by_elements.options.solver = method.name;
            by_elements.options.transport = transport;
            all.push_back(by_elements);
        }
    return all;
}

// How GoogleTest names a parameter in its messages.
void PrintTo(const Method& method, std::ostream* out) {
    *out << method.name;
}

class Solver : public testing::TestWithParam<std::tuple<Method, Case>> {};

TEST_P(Solver, MeetsTheClosedForm) {
    const auto& [method, c] = GetParam();
    SolveOptions options = method.options;
    options.error = method.less * c.error;
    if (method.less > 1) options.element_size = c.even_element_size;
    const Solution solution = light(c.scene, options);
    EXPECT_LE(std::abs(solution.energy.imbalance()), method.less * c.imbalance)
        << "light must not be lost";

    Spectrum scale(3, 0.0);
    for (const Probe& probe : c.probes)
        for (std::size_t b = 0; b < 3; ++b) scale[b] = std::max(scale[b], probe.irradiance[b]);
    const Surfaces surfaces(solution, Backs::black);
    for (std::size_t p = 0; p < c.probes.size(); ++p) {
        const Probe& probe = c.probes[p];
        std::vector<double> found(solution.columns());
        ASSERT_TRUE(probe_surface(surfaces, probe.position, probe.normal, found))
            << "no surface at probe " << p;
        for (std::size_t b = 0; b < 3; ++b) {
            double all_groups = 0;
            for (std::size_t g = 0; g < solution.groups.size(); ++g) all_groups += found[3 * g + b];
            EXPECT_NEAR(all_groups, probe.irradiance[b], method.less * c.tolerance * scale[b])
                << "probe " << p << ", band " << b << ": " << c.why;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(EveryMethod, Solver,
                         testing::Combine(testing::ValuesIn(methods()),
                                          testing::ValuesIn(closed_form_cases())),
                         [](const auto& test) {
                             return std::get<0>(test.param).name + "_" +
                                    std::get<1>(test.param).name;
                         });

}  // namespace
}  // namespace exitance::analytic
