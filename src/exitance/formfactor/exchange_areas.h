// SPDX-License-Identifier: Apache-2.0
// Form factors as what is symmetric in them: exchange areas S_ij = A_i F_ij = A_j F_ji
// (reciprocity).
#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace exitance {

/// The lower triangle of a symmetric matrix [m²], in float; a row is kept dense or as its non-zero
/// entries, whichever takes less memory.
class ExchangeAreas {
  public:
    explicit ExchangeAreas(std::size_t rows) : rows_(rows) {}

    std::size_t rows() const { return rows_.size(); }
    /// S_i0 … S_ii; `areas` has i + 1 values. Threads may set different rows at once.
    void set_row(std::size_t i, std::span<const float> areas);
    /// The same from entries in ascending order of their columns, all ≤ i.
    void set_row(std::size_t i, std::vector<std::uint32_t> columns, std::vector<float> areas);
    double at(std::size_t i, std::size_t j) const;

    /// Calls visit(j, S_ij) for the entries of row i with j ≤ i that are kept, ascending.
    template <class Visit>
    void visit_row(std::size_t i, Visit&& visit) const {
        if (const auto* dense = std::get_if<Dense>(&rows_[i])) {
            for (std::size_t j = 0; j < dense->size(); ++j) visit(j, (*dense)[j]);
            return;
        }
        const Sparse& sparse = std::get<Sparse>(rows_[i]);
        for (std::size_t k = 0; k < sparse.columns.size(); ++k)
            visit(std::size_t{sparse.columns[k]}, sparse.areas[k]);
    }

    /// Σ_j S_ij x_j, of the whole symmetric matrix.
    std::vector<double> times(const std::vector<double>& x) const;

    std::size_t bytes() const;

  private:
    using Dense = std::vector<float>;
    struct Sparse {
        std::vector<std::uint32_t> columns{};
        std::vector<float> areas{};
    };
    std::vector<std::variant<Sparse, Dense>> rows_;
};

}  // namespace exitance
