// SPDX-License-Identifier: Apache-2.0
// Conjugate gradients (Hestenes & Stiefel 1952) with a diagonal preconditioner, for operators that
// are not stored as a matrix.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace exitance {

/// Solves M x = b for a symmetric positive semidefinite M with a solution: `apply(x, y)` sets
/// y = M x; `diagonal` is M's, positive. Starts from `x`; returns |b − M x| / |b| where it ended:
/// at most `tolerance`, or after `most` steps.
template <class Apply>
double conjugate_gradients(const Apply& apply, const std::vector<double>& diagonal,
                           const std::vector<double>& b, std::vector<double>& x, double tolerance,
                           std::size_t most) {
    const std::size_t n = b.size();
    const auto inner = [n](const std::vector<double>& u, const std::vector<double>& v) {
        double sum = 0;
        for (std::size_t i = 0; i < n; ++i) sum += u[i] * v[i];
        return sum;
    };
    std::vector<double> r(n), z(n), p(n), q(n);
    apply(x, q);
    for (std::size_t i = 0; i < n; ++i) r[i] = b[i] - q[i];
    const double size = std::sqrt(inner(b, b));
    if (size == 0) {
        x.assign(n, 0.0);
        return 0;
    }
    for (std::size_t i = 0; i < n; ++i) p[i] = z[i] = r[i] / diagonal[i];
    double rz = inner(r, z);
    for (std::size_t step = 0; step < most && std::sqrt(inner(r, r)) > tolerance * size; ++step) {
        apply(p, q);
        const double curvature = inner(p, q);
        if (!(curvature > 0)) break;  // p is in the null space
        const double alpha = rz / curvature;
        for (std::size_t i = 0; i < n; ++i) x[i] += alpha * p[i], r[i] -= alpha * q[i];
        for (std::size_t i = 0; i < n; ++i) z[i] = r[i] / diagonal[i];
        const double next = inner(r, z);
        for (std::size_t i = 0; i < n; ++i) p[i] = z[i] + next / rz * p[i];
        rz = next;
    }
    return std::sqrt(inner(r, r)) / size;
}

}  // namespace exitance
