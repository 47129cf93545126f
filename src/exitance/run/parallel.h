// SPDX-License-Identifier: Apache-2.0
// Loops whose result does not depend on the number of threads: the range is cut into blocks of
// fixed size, and sums are added in block order.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace exitance {

/// Calls `body(begin, end)` for consecutive blocks of at most `block` indices of [0, count).
template <class Body>
void parallel_blocks(std::size_t count, std::size_t block, const Body& body) {
    const std::size_t blocks = (count + block - 1) / block;
    if (blocks == 0) return;
    if (blocks == 1) return body(std::size_t{0}, count);
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, blocks, 1),
        [&](const tbb::blocked_range<std::size_t>& r) {
            for (std::size_t b = r.begin(); b != r.end(); ++b)
                body(b * block, std::min(count, (b + 1) * block));
        },
        tbb::simple_partitioner());
}

/// Calls `body(i)` for every i in [0, count).
template <class Body>
void parallel_for(std::size_t count, const Body& body, std::size_t block = 256) {
    parallel_blocks(count, block, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i != end; ++i) body(i);
    });
}

/// Sum over [0, count) of `body(begin, end)` per block, added in block order. `T{}` is zero.
template <class T, class Body>
T parallel_sum(std::size_t count, const Body& body, std::size_t block = 1024) {
    std::vector<T> partial((count + block - 1) / block);
    parallel_blocks(count, block, [&](std::size_t begin, std::size_t end) {
        partial[begin / block] = body(begin, end);
    });
    T sum{};
    for (const T& p : partial) sum += p;
    return sum;
}

}  // namespace exitance
