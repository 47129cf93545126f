// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/form_factor_matrix.h"

#include <algorithm>

namespace exitance {

namespace {

using Entry = FormFactorMatrix::Entry;

// Rows begin … end of the full matrix S, of which the lower triangle is kept: what is right of the
// diagonal stands in later rows.
void visit_block(const ExchangeAreas& S, const std::vector<double>& areas, std::size_t begin,
                 std::size_t end,
                 const std::function<void(std::size_t, std::span<const Entry>)>& visit) {
    std::vector<std::vector<Entry>> rows(end - begin);
    const auto factor = [&](std::size_t i, float area) {
        return static_cast<float>(static_cast<double>(area) / areas[i]);
    };
    for (std::size_t i = begin; i < S.rows(); ++i)
        S.visit_row(i, [&](std::size_t j, float area) {
            if (area == 0) return;
            if (i < end)
                rows[i - begin].push_back({static_cast<std::uint32_t>(j), factor(i, area)});
            if (j >= begin && j < end && j != i)
                rows[j - begin].push_back({static_cast<std::uint32_t>(i), factor(j, area)});
        });
    for (std::size_t i = begin; i < end; ++i) visit(i, rows[i - begin]);
}

}  // namespace

void FormFactorMatrix::set_row(std::size_t i, std::span<const double> factors) {
    std::vector<Entry> entries;
    for (std::size_t j = 0; j < factors.size(); ++j)
        if (factors[j] > 0)
            entries.push_back({static_cast<std::uint32_t>(j), static_cast<float>(factors[j])});
    set_row(i, std::move(entries));
}

void FormFactorMatrix::for_rows(
    const std::function<void(std::size_t, std::span<const Entry>)>& visit) const {
    if (!exchange_) {
        for (std::size_t i = 0; i < rows_.size(); ++i) visit(i, rows_[i]);
        return;
    }
    // A block's rows are collected in one pass over the triangle: at most eight passes, and memory
    // for an eighth of the matrix.
    const std::size_t block = std::max<std::size_t>(16, (rows() + 7) / 8);
    for (std::size_t begin = 0; begin < rows(); begin += block)
        visit_block(*exchange_, areas_, begin, std::min(rows(), begin + block), visit);
}

std::size_t FormFactorMatrix::bytes() const {
    std::size_t sum = areas_.capacity() * sizeof(double);
    if (exchange_) return sum + exchange_->bytes();
    sum += rows_.capacity() * sizeof(rows_[0]);
    for (const auto& row : rows_) sum += row.capacity() * sizeof(Entry);
    return sum;
}

ExchangeAreas symmetrised(const FormFactorMatrix& F) {
    if (F.exchange_areas()) return *F.exchange_areas();
    const std::vector<double>& A = F.areas();
    // Var(A_i F_ij) ∝ A_i²: S = (A_j² · A_i F_ij + A_i² · A_j F_ji) / (A_i² + A_j²).
    std::vector<std::vector<std::pair<std::uint32_t, double>>> lower(F.rows());
    F.for_rows([&](std::size_t i, std::span<const Entry> entries) {
        for (const Entry& e : entries) {
            const std::size_t j = e.column;
            const double share = j == i ? 1 : A[j] * A[j] / (A[i] * A[i] + A[j] * A[j]);
            lower[std::max(i, j)].emplace_back(static_cast<std::uint32_t>(std::min(i, j)),
                                               share * A[i] * static_cast<double>(e.value));
        }
    });
    ExchangeAreas S(F.rows());
    for (std::size_t i = 0; i < F.rows(); ++i) {
        std::stable_sort(lower[i].begin(), lower[i].end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        std::vector<std::uint32_t> columns;
        std::vector<float> areas;
        for (std::size_t k = 0; k < lower[i].size();) {
            const std::uint32_t j = lower[i][k].first;
            double sum = 0;
            for (; k < lower[i].size() && lower[i][k].first == j; ++k) sum += lower[i][k].second;
            columns.push_back(j);
            areas.push_back(static_cast<float>(sum));
        }
        S.set_row(i, std::move(columns), std::move(areas));
        std::vector<std::pair<std::uint32_t, double>>().swap(lower[i]);
    }
    return S;
}

}  // namespace exitance
