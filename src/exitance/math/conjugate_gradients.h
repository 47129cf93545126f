// SPDX-License-Identifier: Apache-2.0
// Conjugate gradients (Hestenes & Stiefel 1952) with a diagonal preconditioner, for operators that
// are not stored as a matrix.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace exitance {

/// Solves M x = b for a symmetric positive semidefinite M with a solution: `apply(x)` is M x;
/// `diagonal` is M's, positive. Starts from `x`; returns |b − M x| / |b| where it ended: at most
/// `tolerance`, or after `most` steps. `x` stays as it is where the method breaks down.
double conjugate_gradients(
    const std::function<std::vector<double>(const std::vector<double>&)>& apply,
    const std::vector<double>& diagonal, const std::vector<double>& b, std::vector<double>& x,
    double tolerance, std::size_t most);

}  // namespace exitance
