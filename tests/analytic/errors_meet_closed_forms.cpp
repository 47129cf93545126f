// SPDX-License-Identifier: Apache-2.0
// The error asked for, the error reached and the error that is printed, where light is known
// exactly.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "analytic/scenes.h"
#include "exitance/math/warp.h"
#include "exitance/pipeline.h"
#include "exitance/run/random.h"
#include "exitance/solution/surfaces.h"

namespace exitance::analytic {
namespace {

/// RMS error over mean, of luminance; `doubt` is its standard error.
struct Found {
    double rms = 0, doubt = 0;
    double mean_reflectance = 0;
};

/// What a solution says where, and how it changes around there.
struct Piece {
    std::uint32_t triangle;
    double area, change;
};

std::vector<Piece> pieces_of(const Solution& solution, const Surfaces& surfaces) {
    std::vector<Piece> out;
    std::vector<double> told(solution.columns());
    for (std::uint32_t t = 0; t < solution.triangles.size(); ++t) {
        const Material& material = solution.materials[surfaces.part(t).material];
        if (material.emits() && luminance(material.reflectance) == 0) continue;
        std::array<double, 3> level{};
        for (std::size_t i = 0; i < 3; ++i) {
            SurfacePlace corner{t, {}};
            corner.weights[i] = 1;
            surfaces.irradiance(corner, told);
            level[i] = solution.luminance(told);
        }
        const auto [low, high] = std::minmax_element(level.begin(), level.end());
        const auto [p, q, r] = surfaces.corners(t);
        out.push_back({t, 0.5 * length(cross(q - p, r - p)), *high - *low});
    }
    return out;
}

/// By points on all that receives light. A sharp shadow lies in a thousandth of the area: half of
/// the points are spread evenly, half where light changes.
Found error_of(const Solution& solution, const Case& c) {
    constexpr std::size_t count = 65536;
    const Surfaces surfaces(solution, Backs::black);
    const std::vector<Piece> pieces = pieces_of(solution, surfaces);
    Found out;
    double area = 0, change = 0;
    for (const Piece& piece : pieces) {
        const Material& material = solution.materials[surfaces.part(piece.triangle).material];
        area += piece.area, change += piece.area * piece.change;
        out.mean_reflectance += piece.area * luminance(material.reflectance);
    }
    out.mean_reflectance /= area;
    std::vector<double> cumulative, weight;
    double total = 0;
    for (const Piece& piece : pieces) {
        const double even = piece.area / area;
        const double share = change > 0 ? 0.5 * even * (1 + piece.change * area / change) : even;
        cumulative.push_back(total += share);
        weight.push_back(even / share);
    }
    struct Sample {
        double weight, square;
    };
    std::vector<Sample> samples;
    std::vector<double> told(solution.columns());
    double all = 0, mean = 0, square = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double at = (double(i) + uniform(5, 3 * i)) / count * total;
        const auto above = std::upper_bound(cumulative.begin(), cumulative.end(), at);
        const auto nth =
            std::min(static_cast<std::size_t>(above - cumulative.begin()), pieces.size() - 1);
        const auto w = uniform_triangle({uniform(5, 3 * i + 1), uniform(5, 3 * i + 2)});
        const SurfacePlace place{pieces[nth].triangle, {w[0], w[1], w[2]}};
        const auto [p, q, r] = surfaces.corners(place.triangle);
        const auto exact = c.exact(p * w[0] + q * w[1] + r * w[2], normalized(cross(q - p, r - p)));
        if (!exact) continue;
        surfaces.irradiance(place, told);
        const double error = solution.luminance(told) - luminance(*exact);
        all += weight[nth];
        mean += weight[nth] * luminance(*exact);
        square += weight[nth] * error * error;
        samples.push_back({weight[nth], error * error});
    }
    mean /= all, square /= all;
    double spread = 0;
    for (const Sample& s : samples) spread += std::pow(s.weight * (s.square - square), 2);
    out.rms = std::sqrt(square) / mean;
    if (square > 0) out.doubt = std::sqrt(spread) / all / (mean * mean) / (2 * out.rms);
    return out;
}

// Of 78 comparisons one departs by more by chance once in 200 times.
constexpr double standard_errors = 4;

class Error : public testing::TestWithParam<Case> {};

TEST_P(Error, IsTheOneAskedForAndTheOneTold) {
    const Case& c = GetParam();
    for (const double asked : {0.05, 0.02, 0.01}) {
        SolveOptions options;
        options.error = asked;
        SCOPED_TRACE(asked);
        const Solution solution = light(c.scene, options);
        const Found found = error_of(solution, c);
        ASSERT_TRUE(solution.error);
        const auto [told, confidence, points] = *solution.error;
        const double own =
            std::sqrt(std::max(0.0, found.rms * found.rms - c.departure * c.departure));
        const double doubt = standard_errors * std::hypot(found.doubt, confidence);
        EXPECT_LE(own, asked);
        // Held-out points count the mean of all errors 1 / (1 - rho) times, as if every reflection
        // repeated it; where it is one of interpolation, they say too much by up to that factor.
        EXPECT_GE(told, own - doubt);
        EXPECT_LE(told, own / (1 - found.mean_reflectance) + doubt);
    }
}

INSTANTIATE_TEST_SUITE_P(ClosedForms, Error, testing::ValuesIn(closed_form_cases()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace exitance::analytic
