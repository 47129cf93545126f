// SPDX-License-Identifier: Apache-2.0
// Counter-based random numbers and a low-discrepancy sequence: the value depends only on what it
// is for (seed, item, index), never on which thread asks or in what order.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace exitance {

/// 64-bit finaliser with full avalanche (Stafford 2011, variant 13, as in SplitMix64).
constexpr std::uint64_t hash_bits(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
}

/// One number from several, for use as the key of a stream.
template <class... Rest>
constexpr std::uint64_t hash_bits(std::uint64_t first, Rest... rest) {
    return hash_bits(first ^
                     (hash_bits(static_cast<std::uint64_t>(rest)...) * 0x9ddfea08eb382d69ULL));
}

/// Top 53 bits as a double in [0, 1).
constexpr double unit_interval(std::uint64_t bits) {
    return static_cast<double>(bits >> 11) * 0x1.0p-53;
}

/// 32 bits as a float in [0, 1).
constexpr float unit_interval(std::uint32_t bits) {
    return static_cast<float>(bits >> 8) * 0x1.0p-24f;
}

/// The `counter`-th uniform number in [0, 1) of the stream `key`.
constexpr double uniform(std::uint64_t key, std::uint64_t counter) {
    return unit_interval(hash_bits(key + counter * 0xd1342543de82ef95ULL));
}

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
    x = (x >> 16) | (x << 16);
    x = ((x & 0x00ff00ffU) << 8) | ((x & 0xff00ff00U) >> 8);
    x = ((x & 0x0f0f0f0fU) << 4) | ((x & 0xf0f0f0f0U) >> 4);
    x = ((x & 0x33333333U) << 2) | ((x & 0xccccccccU) >> 2);
    return ((x & 0x55555555U) << 1) | ((x & 0xaaaaaaaaU) >> 1);
}

/// First two dimensions of the Sobol' sequence as 32-bit fractions (Sobol' 1967): van der Corput,
/// and the matrix of the polynomial x + 1, whose columns are v_k = v_{k-1} ^ (v_{k-1} >> 1).
constexpr std::array<std::uint32_t, 2> sobol(std::uint32_t index) {
    std::uint32_t y = 0;
    for (std::uint32_t v = 0x80000000U, i = index; i != 0; i >>= 1, v ^= v >> 1)
        if (i & 1U) y ^= v;
    return {reverse_bits(index), y};
}

/// Direction numbers of the sequence's third and fourth dimension: m_k of the polynomials x² + x +
/// 1 and x³ + x + 1, begun with 1, 3 and 1, 3, 1 (Joe & Kuo 2008, "Constructing Sobol' sequences
/// with better two-dimensional projections").
inline constexpr auto sobol_directions = [] {
    std::array<std::array<std::uint32_t, 32>, 2> v{};
    std::array<std::uint32_t, 32> m{1, 3}, n{1, 3, 1};
    for (std::size_t k = 2; k < 32; ++k) m[k] = 2 * m[k - 1] ^ 4 * m[k - 2] ^ m[k - 2];
    for (std::size_t k = 3; k < 32; ++k) n[k] = 4 * n[k - 2] ^ 8 * n[k - 3] ^ n[k - 3];
    for (std::size_t k = 0; k < 32; ++k) v[0][k] = m[k] << (31 - k), v[1][k] = n[k] << (31 - k);
    return v;
}();

/// Owen scrambling of one dimension by a hash (Laine & Karras 2011 in the form of Burley 2020,
/// "Practical Hash-based Owen Scrambling", JCGT 9(4)).
constexpr std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
    x = reverse_bits(x);
    x ^= x * 0x3d20adeaU;
    x += seed;
    x *= (seed >> 16) | 1U;
    x ^= x * 0x05526c56U;
    x ^= x * 0x53a22864U;
    return reverse_bits(x);
}

/// Point `index` of the Owen-scrambled Sobol' sequence of the stream `key`, in [0, 1)². Every
/// prefix whose length is a power of two is stratified, so that sampling may stop early without
/// bias.
constexpr std::array<double, 2> low_discrepancy(std::uint64_t key, std::uint32_t index) {
    const auto [x, y] = sobol(index);
    return {owen_scramble(x, static_cast<std::uint32_t>(key)) * 0x1.0p-32,
            owen_scramble(y, static_cast<std::uint32_t>(key >> 32)) * 0x1.0p-32};
}

/// The same in [0, 1)⁴: for pairs of points, or a point and a direction.
constexpr std::array<double, 4> low_discrepancy_4(std::uint64_t key, std::uint32_t index) {
    const auto [x, y] = low_discrepancy(key, index);
    std::uint32_t z = 0, w = 0;
    for (std::uint32_t k = 0, i = index; i != 0; i >>= 1, ++k) {
        if ((i & 1U) == 0) continue;
        z ^= sobol_directions[0][k];
        w ^= sobol_directions[1][k];
    }
    const std::uint64_t other = hash_bits(key);
    return {x, y, owen_scramble(z, static_cast<std::uint32_t>(other)) * 0x1.0p-32,
            owen_scramble(w, static_cast<std::uint32_t>(other >> 32)) * 0x1.0p-32};
}

}  // namespace exitance
