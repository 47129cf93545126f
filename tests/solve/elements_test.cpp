// SPDX-License-Identifier: Apache-2.0
// Solvers of elements: groups, threads and black rows.
#include <gtest/gtest.h>

#include <algorithm>

#include "exitance/pipeline.h"
#include "exitance/solve/element_methods.h"
#include "solve/solve_scenes.h"

namespace exitance {
namespace {

SolveOptions options_of(std::string_view solver, std::string_view transport) {
    SolveOptions options;
    options.error = 0.1;
    options.unshot = 1e-5;
    options.solver = solver;
    options.transport = transport;
    return options;
}

// Black lamps: rows with zero reflectance.
Scene room_with(bool warm, bool cold) {
    Scene scene = solve_scenes::two_lamp_room();
    for (Material& material : scene.materials)
        if ((material.group == "warm" && !warm) || (material.group == "cold" && !cold))
            material.exitance = {0, 0, 0};
    return scene;
}

class Elements : public ::testing::TestWithParam<std::string_view> {};

TEST_P(Elements, AreTheSameOnAnyNumberOfThreads) {
    for (const std::string_view transport : transports) {
        if (!go_together(element_method(std::string(GetParam())), transport)) continue;
        SolveOptions options = options_of(GetParam(), transport);
        if (options.solver == "stochastic" || transport == "stochastic") options.unshot.reset();
        options.threads = 1;
        const Solution one = light(room_with(true, true), options);
        options.threads = 3;
        const Solution three = light(room_with(true, true), options);
        ASSERT_EQ(one.irradiance.values().size(), three.irradiance.values().size());
        for (std::size_t i = 0; i < one.irradiance.values().size(); ++i)
            ASSERT_EQ(one.irradiance.values()[i], three.irradiance.values()[i]) << transport;
    }
}

// Light is linear: two lamps that are solved together are the two alone. Columns are rounded and
// stopped together, which 1e-5 of the light leaves room for.
TEST_P(Elements, GroupsSolvedTogetherAreEachAlone) {
    if (GetParam() == "stochastic") GTEST_SKIP() << "samples follow the sum of the groups";
    for (const std::string_view transport : {"dense", "sparse"}) {
        const SolveOptions options = options_of(GetParam(), transport);
        const Solution both = light(room_with(true, true), options);
        double sum = 0, alone_sum = 0;
        const auto total = [](const Solution& solution) {
            double all = 0;
            for (std::size_t v = 0; v < solution.irradiance.rows(); ++v)
                for (std::size_t c = 0; c < solution.columns(); ++c)
                    all += double(solution.irradiance[VertexId(v)][c]);
            return all;
        };
        sum = total(both);
        alone_sum = total(light(room_with(true, false), options)) +
                    total(light(room_with(false, true), options));
        EXPECT_GT(sum, 1);
        EXPECT_NEAR(sum, alone_sum, 2e-3 * sum) << transport;
    }
}

INSTANTIATE_TEST_SUITE_P(EverySolver, Elements, ::testing::ValuesIn([] {
                             std::vector<std::string_view> names;
                             for (const ElementMethod& method : element_methods())
                                 names.push_back(method.name);
                             return names;
                         }()),
                         [](const auto& test) {
                             std::string name(test.param);
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

}  // namespace
}  // namespace exitance
