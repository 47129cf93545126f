// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/closure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/math/conjugate_gradients.h"
#include "exitance/run/error.h"

namespace exitance {

namespace {

using Entry = FormFactorMatrix::Entry;

// A row that adds up to less or more than this is not a rounding error of a closed enclosure.
constexpr double least_closed = 0.9, most_closed = 1.1;
constexpr int most_rounds = 20;

double reciprocity_defect(const FormFactorMatrix& F) {
    if (F.exchange_areas()) return 0;
    const std::vector<double>& A = F.areas();
    // +A_i F_ij and −A_j F_ji meet in the row of the larger index.
    std::vector<std::vector<std::pair<std::uint32_t, double>>> lower(F.rows());
    F.for_rows([&](std::size_t i, std::span<const Entry> entries) {
        for (const Entry& e : entries) {
            const std::size_t j = e.column;
            if (j == i) continue;
            const double S = A[i] * static_cast<double>(e.value);
            lower[std::max(i, j)].emplace_back(static_cast<std::uint32_t>(std::min(i, j)),
                                               j < i ? S : -S);
        }
    });
    double worst = 0;
    for (std::size_t i = 0; i < F.rows(); ++i) {
        std::sort(lower[i].begin(), lower[i].end());
        for (std::size_t k = 0; k < lower[i].size();) {
            const std::uint32_t j = lower[i][k].first;
            double difference = 0;
            for (; k < lower[i].size() && lower[i][k].first == j; ++k)
                difference += lower[i][k].second;
            worst = std::max(worst, std::abs(difference) / std::min(A[i], A[j]));
        }
    }
    return worst;
}

void require_closed(const FormFactorMatrix& F, const std::vector<std::string>& names) {
    const MatrixQuality q = quality(F);
    const bool open = q.least_sum < least_closed;
    if (!open && q.most_sum <= most_closed) return;
    throw Error(Fault::wrong_use,
                fmt::format("--enforce: the factors of '{}' add up to {:.3f}: the enclosure is "
                            "{}, expected a closed one",
                            names[open ? q.least_row : q.most_row], open ? q.least_sum : q.most_sum,
                            open ? "open" : "not consistent"));
}

FormFactorMatrix rows_scaled(const FormFactorMatrix& F) {
    FormFactorMatrix out(F.areas());
    F.for_rows([&](std::size_t i, std::span<const Entry> entries) {
        double sum = 0;
        for (const Entry& e : entries) sum += static_cast<double>(e.value);
        std::vector<Entry> row(entries.begin(), entries.end());
        for (Entry& e : row) e.value = static_cast<float>(static_cast<double>(e.value) / sum);
        out.set_row(i, std::move(row));
    });
    return out;
}

// S_ij (1 + λ_i + λ_j), never below zero; true if something had to be held there.
bool correct(ExchangeAreas& S, const std::vector<double>& lambda) {
    bool held = false;
    for (std::size_t i = 0; i < S.rows(); ++i) {
        std::vector<std::uint32_t> columns;
        std::vector<float> areas;
        S.visit_row(i, [&](std::size_t j, float area) {
            if (area == 0) return;
            const double factor = 1 + lambda[i] + lambda[j];
            held |= factor < 0;
            columns.push_back(static_cast<std::uint32_t>(j));
            areas.push_back(static_cast<float>(static_cast<double>(area) * std::max(0.0, factor)));
        });
        S.set_row(i, std::move(columns), std::move(areas));
    }
    return held;
}

ExchangeAreas closed(ExchangeAreas S, const std::vector<double>& A) {
    const std::size_t n = S.rows();
    // Once more where entries were held at zero, and against the rounding of floats.
    for (int round = 0; round < most_rounds; ++round) {
        const std::vector<double> sums = S.times(std::vector<double>(n, 1.0));
        std::vector<double> right(n), diagonal(n), lambda(n);
        double worst = 0;
        for (std::size_t i = 0; i < n; ++i) {
            right[i] = A[i] - sums[i];
            diagonal[i] = sums[i] > 0 ? sums[i] + S.at(i, i) : 1;
            worst = std::max(worst, std::abs(right[i]) / A[i]);
        }
        if (worst < 3e-7) break;
        conjugate_gradients(
            [&](const std::vector<double>& x) {
                std::vector<double> y = S.times(x);
                for (std::size_t i = 0; i < n; ++i) y[i] += sums[i] * x[i];
                return y;
            },
            diagonal, right, lambda, 1e-9, 1000);
        if (!correct(S, lambda) && round >= 2) break;
    }
    return S;
}

}  // namespace

MatrixQuality quality(const FormFactorMatrix& F) {
    MatrixQuality out;
    out.least_sum = INFINITY;
    out.most_sum = -INFINITY;
    double all = 0;
    F.for_rows([&](std::size_t i, std::span<const Entry> entries) {
        double sum = 0;
        for (const Entry& e : entries) {
            sum += static_cast<double>(e.value);
            out.entries += e.value != 0 ? 1 : 0;
        }
        if (sum < out.least_sum) out.least_sum = sum, out.least_row = i;
        if (sum > out.most_sum) out.most_sum = sum, out.most_row = i;
        all += sum;
    });
    out.mean_sum = all / static_cast<double>(F.rows());
    out.reciprocity_defect = reciprocity_defect(F);
    return out;
}

Enforce enforce_by_name(const std::string& name) {
    if (name == "reciprocity") return Enforce::reciprocity;
    if (name == "closure") return Enforce::closure;
    if (name == "both") return Enforce::both;
    return Enforce::none;
}

FormFactorMatrix enforced(FormFactorMatrix F, Enforce what, const std::vector<std::string>& names) {
    if (what == Enforce::none) return F;
    if (what != Enforce::reciprocity) require_closed(F, names);
    if (what == Enforce::closure) return rows_scaled(F);
    ExchangeAreas S = symmetrised(F);
    if (what == Enforce::both) S = closed(std::move(S), F.areas());
    return {F.areas(), std::move(S)};
}

}  // namespace exitance
