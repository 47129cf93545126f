// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/closure.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "enclosures.h"
#include "exitance/run/error.h"
#include "exitance/run/random.h"

namespace exitance {
namespace {

using enclosures::dense;
using Entry = FormFactorMatrix::Entry;

FormFactorMatrix matrix(const std::vector<double>& areas,
                        const std::vector<std::vector<double>>& rows) {
    FormFactorMatrix F(areas);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        std::vector<Entry> entries;
        for (std::size_t j = 0; j < rows[i].size(); ++j)
            if (rows[i][j] != 0)
                entries.push_back({static_cast<std::uint32_t>(j), static_cast<float>(rows[i][j])});
        F.set_row(i, std::move(entries));
    }
    return F;
}

const std::vector<std::string> names{"a", "b", "c"};
// A triangular duct of unit sides is 0.5 everywhere off the diagonal; this one is disturbed.
const std::vector<std::vector<double>> disturbed{{0, 0.52, 0.49}, {0.50, 0, 0.47}, {0.5, 0.53, 0}};

TEST(Closure, IsMeasured) {
    const MatrixQuality q =
        quality(matrix({1, 2, 1}, {{0, 0.6, 0.2}, {0.25, 0, 0.5}, {0, 1.5, 0}}));
    EXPECT_NEAR(q.least_sum, 0.75, 1e-6);
    EXPECT_EQ(q.least_row, 1U);
    EXPECT_NEAR(q.most_sum, 1.5, 1e-6);
    EXPECT_EQ(q.most_row, 2U);
    EXPECT_NEAR(q.mean_sum, (0.8 + 0.75 + 1.5) / 3, 1e-6);
    EXPECT_EQ(q.entries, 5U);
    // A_2 F_23 = 1, A_3 F_32 = 1.5: 0.5 of the smaller area; A_1 F_13 = 0.2 is less.
    EXPECT_NEAR(q.reciprocity_defect, 0.5, 1e-6);
}

TEST(Closure, OfNothingChangesNothing) {
    const FormFactorMatrix F = matrix({1, 1, 1}, disturbed);
    EXPECT_EQ(dense(enforced(F, Enforce::none, names)), dense(F));
}

TEST(Closure, ReciprocityWeighsTheSmallerAreaMore) {
    const auto F =
        dense(enforced(matrix({1, 3}, {{0, 0.8}, {0.2, 0}}), Enforce::reciprocity, names));
    // S = (A_2² A_1 F_12 + A_1² A_2 F_21) / (A_1² + A_2²) = (9 · 0.8 + 1 · 0.6) / 10.
    EXPECT_NEAR(F[0][1], 0.78, 1e-6);
    EXPECT_NEAR(F[1][0], 0.26, 1e-6);
}

TEST(Closure, RowsAreDividedByTheirSums) {
    const auto F = dense(enforced(matrix({1, 1, 1}, disturbed), Enforce::closure, names));
    EXPECT_NEAR(F[0][1], 0.52 / 1.01, 1e-6);
    EXPECT_NEAR(F[0][1] + F[0][2], 1, 1e-6);
}

TEST(Closure, BothAreReachedTogether) {
    const FormFactorMatrix F = enforced(matrix({1, 1, 1}, disturbed), Enforce::both, names);
    const MatrixQuality q = quality(F);
    EXPECT_NEAR(q.least_sum, 1, 1e-6);
    EXPECT_NEAR(q.most_sum, 1, 1e-6);
    EXPECT_EQ(q.reciprocity_defect, 0);
    // Three surfaces leave no freedom: a triangle's factors follow from its sides.
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(dense(F)[i][j], i == j ? 0 : 0.5, 1e-6);
}

// Least squares: no change along a direction that keeps symmetry and sums makes it smaller.
RC_GTEST_PROP(Closure, BothIsTheNearest, (std::uint32_t seed)) {
    constexpr std::size_t n = 5;
    std::uint64_t counter = 0;
    const auto draw = [&] { return uniform(hash_bits(seed), counter++); };
    std::vector<double> areas;
    for (std::size_t i = 0; i < n; ++i) areas.push_back(1 + draw());
    std::vector<std::vector<double>> rows(n, std::vector<double>(n));
    for (auto& row : rows) {
        double sum = 0;
        for (double& F : row) sum += F = 0.2 + draw();
        const double close = (0.96 + 0.08 * draw()) / sum;
        for (double& F : row) F *= close;
    }
    const FormFactorMatrix F = matrix(areas, rows);
    const ExchangeAreas before = symmetrised(F);
    const FormFactorMatrix found = enforced(F, Enforce::both, std::vector<std::string>(n, "s"));
    const ExchangeAreas& after = *found.exchange_areas();
    for (std::size_t i = 0; i < n; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < n; ++j) {
            sum += after.at(i, j);
            RC_ASSERT(after.at(i, j) >= 0);
        }
        RC_ASSERT(std::abs(sum - areas[i]) <= 1e-5 * areas[i]);
    }
    // Round a 4-cycle i, j, k, l: +1 −1 +1 −1 keeps the sums. The gradient of Σ (ΔS)² / S along it
    // is Σ ± ΔS / S, zero at the minimum. Rows far from closed, where entries are held at zero,
    // are another matter.
    double gradient = 0, sign = 1;
    const std::array<std::size_t, 4> cycle{0, 1, 2, 3};
    for (std::size_t k = 0; k < 4; ++k, sign = -sign) {
        const std::size_t i = cycle[k], j = cycle[(k + 1) % 4];
        gradient += sign * (after.at(i, j) - before.at(i, j)) / before.at(i, j);
        RC_PRE(after.at(i, j) > 0);
    }
    RC_ASSERT(std::abs(gradient) < 2e-3);
}

TEST(Closure, OfAnOpenEnclosureIsRefused) {
    try {
        enforced(matrix({1, 1}, {{0, 0.2}, {0.2, 0}}), Enforce::both, names);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::wrong_use);
        EXPECT_STREQ(error.what(),
                     "--enforce: the factors of 'a' add up to 0.200: the enclosure is open, "
                     "expected a closed one");
    }
}

}  // namespace
}  // namespace exitance
