// SPDX-License-Identifier: Apache-2.0
// The Cornell box at the default accuracy against brute force.
#include <gtest/gtest.h>

#include <cmath>

#include "exitance/pipeline.h"
#include "exitance/solution/surface_probe.h"
#include "truth/cornell_box.h"
#include "truth/cornell_truth.h"

namespace exitance {
namespace {

// Distance from p to the outline of a block's base, in the plane of the floor.
double distance_to_outline(const Scene& scene, const std::string& surface, const Vec3& p) {
    double nearest = INFINITY;
    for (const Polygon& polygon : scene.polygons) {
        if (scene.surfaces[polygon.surface].name != surface) continue;
        const auto corners = scene.corners(polygon);
        for (std::size_t i = 0; i < 4; ++i) {
            const Vec3 a = corners[i], b = corners[(i + 1) % 4];
            if (a.y != 0 || b.y != 0) continue;
            const double t = std::clamp(dot(p - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
            nearest = std::min(nearest, length(p - a - (b - a) * t));
        }
    }
    return nearest;
}

TEST(CornellBox, MeetsBruteForceWithinTheErrorAskedFor) {
    const Scene scene = truth::cornell_box();
    const auto receivers = truth::cornell_receivers();
    const truth::CornellTruth exact = truth::read_cornell_truth();
    SolveOptions options;
    options.error = 0.02;
    const Solution solution = light(scene, options);
    EXPECT_LT(std::abs(solution.energy.imbalance()), 0.005);
    const Surfaces surfaces(solution, Backs::black);

    double mean = 0;
    for (const double value : exact.mean) mean += value / double(exact.mean.size());
    // A texel whose square reaches across the outline of a block has no one value: part of it is
    // covered, and interpolation across a contact is no measure of the rest.
    const double reach = 0.5 * std::hypot(.5528 / 64, .5592 / 64);
    for (std::size_t grid = 0; grid < 2; ++grid) {
        double square = 0, noise = 0, bias = 0, worst = 0;
        std::size_t count = 0, left_out = 0, worst_at = 0;
        for (std::size_t i = grid * 4096; i < (grid + 1) * 4096; ++i) {
            const Vec3 p = receivers[i].position;
            if (exact.mean[i] == 0 ||  // under a block
                distance_to_outline(scene, "short_block", p) < reach ||
                distance_to_outline(scene, "tall_block", p) < reach) {
                ++left_out;
                continue;
            }
            std::vector<double> found(solution.columns());
            ASSERT_TRUE(probe_surface(surfaces, p, receivers[i].normal, found)) << i;
            const double error = (found[truth::green] - exact.mean[i]) / mean;
            square += error * error, bias += error;
            noise += std::pow(exact.standard_error[i] / mean, 2);
            if (std::abs(error) > worst) worst = std::abs(error), worst_at = i - grid * 4096;
            ++count;
        }
        const std::string name = scene.grids[grid].name;
        EXPECT_LE(std::sqrt(square / double(count)), 0.02)
            << name << ", of which the truth's own noise " << std::sqrt(noise / double(count));
        EXPECT_LE(std::abs(bias) / double(count), 0.01) << name;
        EXPECT_LE(worst, 0.15) << name << " texel " << worst_at % 64 << ", " << worst_at / 64;
        EXPECT_GT(count, 3000u) << name << ": too much left out";
        EXPECT_EQ(left_out > 0, grid == 0) << name << ": blocks stand on the floor only";
        RecordProperty("rms_" + name, std::to_string(std::sqrt(square / double(count))));
        RecordProperty("worst_" + name, std::to_string(worst));
    }
}

}  // namespace
}  // namespace exitance
