// SPDX-License-Identifier: Apache-2.0
// The error that held-out points tell, and how far it may be believed.
#include "exitance/solution/error_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "exitance/pipeline.h"
#include "solve/solve_scenes.h"

namespace exitance {
namespace {

using namespace solve_scenes;

// In a room that reflects 98 %, what the points say of the mean error is repeated fifty times.
// Other points say something else, by about as much as each says that it does not know.
TEST(ErrorEstimate, KnowsWhatItDoesNotKnowOfBrightRooms) {
    Scene scene;
    add_room(scene, {}, {3, 2, 2}, 0.98);
    add_lamp(scene, "lamp", {0.7, 1, 1.95}, 0.4, {30, 30, 30});
    add_block(scene, {1.2, 0.8, 0}, {1.8, 1.3, 0.7}, 0.98);
    SolveOptions options;
    options.error = 0.2;
    options.adaptive = false;
    const Solution solution = light(scene, options);
    constexpr int seeds = 12;
    double sum = 0, square = 0, confidence = 0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const auto told = estimate_error(solution, 1000 + seed, 0.05);
        ASSERT_TRUE(told);
        const double rms = told->rms;
        sum += rms, square += rms * rms;
        confidence += told->confidence / seeds;
    }
    const double spread = std::sqrt(square / seeds - sum / seeds * sum / seeds);
    EXPECT_GT(confidence, 0.3 * spread);
    EXPECT_LT(spread, 0.05);
}

}  // namespace
}  // namespace exitance
