// SPDX-License-Identifier: Apache-2.0
#include "exitance/run/parallel.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "exitance/run/random.h"

namespace exitance {
namespace {

template <class Action>
auto with_threads(std::size_t threads, const Action& action) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return action();
}

TEST(ParallelSum, HasTheSameBitsOnAnyNumberOfThreads) {
    for (const std::size_t count : {0, 1, 1023, 1024, 1025, 100'003}) {
        const auto sum = [&] {
            return parallel_sum<float>(count, [](std::size_t begin, std::size_t end) {
                float s = 0;
                for (std::size_t i = begin; i < end; ++i)
                    s += static_cast<float>(std::exp(20 * uniform(1, i) - 10));
                return s;
            });
        };
        const float once = with_threads(1, sum);
        for (int repeat = 0; repeat < 5; ++repeat) EXPECT_EQ(with_threads(2, sum), once) << count;
    }
}

TEST(ParallelSum, BlocksCoverTheRangeOnce) {
    for (const std::size_t block : {1, 7, 100, 1000}) {
        const auto n = parallel_sum<std::size_t>(
            100,
            [&](std::size_t begin, std::size_t end) {
                EXPECT_EQ(begin % block, 0u);
                EXPECT_LE(end - begin, block);
                std::size_t s = 0;
                for (std::size_t i = begin; i < end; ++i) s += i;
                return s;
            },
            block);
        EXPECT_EQ(n, 4950u);
    }
}

TEST(ParallelFor, VisitsEveryIndexOnce) {
    for (const std::size_t count : {0, 1, 255, 256, 257, 10'000}) {
        std::vector<int> visits(count, 0);
        parallel_for(count, [&](std::size_t i) { ++visits[i]; });
        for (const int v : visits) ASSERT_EQ(v, 1) << count;
    }
}

}  // namespace
}  // namespace exitance
