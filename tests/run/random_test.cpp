// SPDX-License-Identifier: Apache-2.0
#include "exitance/run/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace exitance {
namespace {

// Every cell of every elementary interval partition 2^a × 2^b of [0,1)² holds exactly one of
// 2^(a+b) points.
void expect_stratified(std::uint64_t key, std::uint32_t first, int log_count) {
    const std::uint32_t count = 1u << log_count;
    for (int a = 0; a <= log_count; ++a) {
        const int b = log_count - a;
        std::vector<int> hits(count, 0);
        for (std::uint32_t i = first; i < first + count; ++i) {
            const auto [x, y] = low_discrepancy(key, i);
            ASSERT_TRUE(x >= 0 && x < 1 && y >= 0 && y < 1);
            const auto column = static_cast<std::size_t>(std::ldexp(x, a));
            const auto row = static_cast<std::size_t>(std::ldexp(y, b));
            ++hits[(column << b) + row];
        }
        for (const int h : hits)
            ASSERT_EQ(h, 1) << "key " << key << ", points " << first << " + " << count
                            << ", cells 2^" << a << " × 2^" << b;
    }
}

TEST(LowDiscrepancy, EveryPowerOfTwoPrefixIsStratified) {
    for (std::uint64_t k = 0; k < 20; ++k)
        for (int m = 0; m <= 10; ++m) expect_stratified(hash_bits(k), 0, m);
}

TEST(LowDiscrepancy, EveryAlignedRunIsStratifiedToo) {
    for (const std::uint32_t run : {1u, 2u, 5u, 1000u})
        for (int m = 0; m <= 7; ++m) expect_stratified(hash_bits(run), run << m, m);
}

TEST(LowDiscrepancy, ScramblesArePlacedUniformly) {
    // The first point of many streams is uniform: χ² over 16 × 16 cells with 255 degrees of freedom
    // stays below 255 + 5 √510.
    constexpr int cells = 16, streams = 1 << 16;
    for (const std::uint32_t index : {0u, 1u, 7u}) {
        std::vector<int> hits(cells * cells, 0);
        for (std::uint64_t k = 0; k < streams; ++k) {
            const auto [x, y] = low_discrepancy(hash_bits(k, 3u), index);
            ++hits[static_cast<std::size_t>(x * cells) * cells +
                   static_cast<std::size_t>(y * cells)];
        }
        const double expected = double(streams) / (cells * cells);
        double chi2 = 0;
        for (const int h : hits) chi2 += (h - expected) * (h - expected) / expected;
        EXPECT_LT(chi2, 255 + 5 * std::sqrt(510.0)) << index;
        EXPECT_GT(chi2, 255 - 5 * std::sqrt(510.0)) << index << ": too even to be random";
    }
}

TEST(Uniform, HasMeanVarianceAndNoCorrelation) {
    constexpr int n = 1 << 18;
    for (const std::uint64_t key : {std::uint64_t{0}, std::uint64_t{1}, hash_bits(5)}) {
        double sum = 0, square = 0, neighbours = 0, before = uniform(key, n) - 0.5;
        for (std::uint64_t i = 0; i < n; ++i) {
            const double x = uniform(key, i);
            ASSERT_TRUE(x >= 0 && x < 1);
            sum += x, square += x * x;
            neighbours += before * (x - 0.5);
            before = x - 0.5;
        }
        // Five standard errors.
        EXPECT_NEAR(sum / n, 0.5, 5 / std::sqrt(12.0 * n));
        EXPECT_NEAR(square / n, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / n));
        EXPECT_NEAR(neighbours / n, 0, 5.0 / 12 / std::sqrt(n));
    }
}

TEST(UnitInterval, LeavesOutOne) {
    EXPECT_LT(unit_interval(~std::uint64_t{0}), 1.0);
    EXPECT_LT(unit_interval(~std::uint32_t{0}), 1.0f);
    EXPECT_EQ(unit_interval(std::uint64_t{0}), 0.0);
    EXPECT_EQ(unit_interval(std::uint64_t{1} << 63), 0.5);
    EXPECT_EQ(unit_interval(std::uint32_t{1} << 31), 0.5f);
}

TEST(HashBits, TellsItsArgumentsApart) {
    std::set<std::uint64_t> seen;
    for (std::uint64_t a = 0; a < 50; ++a)
        for (std::uint64_t b = 0; b < 50; ++b) {
            seen.insert(hash_bits(a, b));
            seen.insert(hash_bits(a, b, 0));
        }
    EXPECT_EQ(seen.size(), 2u * 50 * 50);
}

TEST(HashBits, EveryBitFlipsHalfOfTheOutput) {
    for (int bit = 0; bit < 64; ++bit) {
        int flipped = 0;
        constexpr int trials = 256;
        for (std::uint64_t k = 0; k < trials; ++k)
            flipped += std::popcount(hash_bits(k) ^ hash_bits(k ^ (std::uint64_t{1} << bit)));
        // Binomial over 64 × 256 bits: mean 8192, deviation 64.
        EXPECT_NEAR(flipped, 32 * trials, 6 * 64) << "input bit " << bit;
    }
}

TEST(ReverseBits, IsItsOwnInverse) {
    EXPECT_EQ(reverse_bits(1u), 0x80000000u);
    for (const std::uint32_t x : {0u, 1u, 0x12345678u, 0xffffffffu, 0xdeadbeefu})
        EXPECT_EQ(reverse_bits(reverse_bits(x)), x);
}

}  // namespace
}  // namespace exitance
