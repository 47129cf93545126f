// SPDX-License-Identifier: Apache-2.0
// Gauss–Legendre rules on [0, 1]: N points are exact for polynomials of degree 2N − 1.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace exitance {

template <std::size_t N>
struct QuadratureRule {
    std::array<double, N> at{}, weight{};  ///< ascending; the weights sum to 1
};

/// Nodes are the zeros of the Legendre polynomial, found by Newton's method (Abramowitz & Stegun
/// 1964, 25.4.29 and 22.16.6).
template <std::size_t N>
const QuadratureRule<N>& gauss_legendre() {
    static const QuadratureRule<N> rule = [] {
        QuadratureRule<N> made;
        for (std::size_t i = 0; i < N; ++i) {
            double x = -std::cos(std::numbers::pi * (double(i) + 0.75) / (double(N) + 0.5));
            double slope = 1;
            for (int step = 0; step < 8; ++step) {
                double p = 1, before = 0;
                for (std::size_t k = 1; k <= N; ++k) {
                    const double next =
                        ((2 * double(k) - 1) * x * p - (double(k) - 1) * before) / double(k);
                    before = p;
                    p = next;
                }
                slope = double(N) * (x * p - before) / (x * x - 1);
                x -= p / slope;
            }
            made.at[i] = 0.5 * (1 + x);
            made.weight[i] = 1 / ((1 - x * x) * slope * slope);
        }
        return made;
    }();
    return rule;
}

}  // namespace exitance
