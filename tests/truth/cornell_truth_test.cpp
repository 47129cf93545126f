// SPDX-License-Identifier: Apache-2.0
#include "truth/cornell_truth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "truth/cornell_box.h"

namespace exitance::truth {
namespace {

TEST(CornellTruth, AgreesWithAFreshEstimate) {
    const CornellTruth stored = read_cornell_truth();
    const auto all = cornell_receivers();
    ASSERT_EQ(all.size(), stored.mean.size());
    std::vector<std::size_t> chosen;
    for (std::size_t i = 37; i < all.size(); i += 83) chosen.push_back(i);
    std::vector<Receiver> receivers;
    for (const std::size_t i : chosen) receivers.push_back(all[i]);
    const Estimate fresh = PathTracer(cornell_box()).irradiance(receivers, {128, 16, 12345});
    double mean = 0, square = 0;
    for (const double value : stored.mean) mean += value / double(stored.mean.size());
    std::size_t lit = 0;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
        const double value = stored.mean[chosen[k]];
        const double error = std::hypot(stored.standard_error[chosen[k]], fresh.error_at(k, green));
        // Errors from 16 replicates follow Student's t with 15 degrees of freedom: beyond 6 lies
        // one of 40 000.
        EXPECT_NEAR(fresh.at(k, green), value, 6 * error + 1e-5 * mean) << "row " << chosen[k];
        EXPECT_LT(fresh.error_at(k, green), 0.03 * mean) << "the judge must be sharp";
        if (value == 0) continue;  // under a block
        square += std::pow((fresh.at(k, green) - value) / error, 2);
        ++lit;
    }
    ASSERT_GT(lit, 80u);
    // Stated errors are the true ones: χ² over its degrees of freedom, 15/13 for Student's t.
    EXPECT_NEAR(square / double(lit), 15.0 / 13, 5 * std::sqrt(3.0 / double(lit)));
}

TEST(CornellTruth, IsSharpEnoughToJudgeOnePercent) {
    const CornellTruth stored = read_cornell_truth();
    for (std::size_t grid = 0; grid < 2; ++grid) {
        double mean = 0, square = 0;
        for (std::size_t i = grid * 4096; i < (grid + 1) * 4096; ++i) {
            mean += stored.mean[i] / 4096;
            square += stored.standard_error[i] * stored.standard_error[i] / 4096;
        }
        EXPECT_LT(std::sqrt(square), 0.004 * mean);
    }
}

}  // namespace
}  // namespace exitance::truth
