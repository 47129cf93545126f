// SPDX-License-Identifier: Apache-2.0
// The matrix F as it is asked for: row by row. Methods that know reciprocity keep it as exchange
// areas, half as many numbers; methods that look from one surface at a time do not, and their
// reciprocity error can be measured.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "exitance/formfactor/exchange_areas.h"

namespace exitance {

/// F_ij is the share of what leaves surface i diffusely that arrives at surface j.
class FormFactorMatrix {
  public:
    struct Entry {
        std::uint32_t column;
        float value;
    };

    /// All zero, not reciprocal by construction. `areas` of the surfaces [m²].
    explicit FormFactorMatrix(std::vector<double> areas)
        : areas_(std::move(areas)), rows_(areas_.size()) {}
    FormFactorMatrix(std::vector<double> areas, ExchangeAreas exchange)
        : areas_(std::move(areas)), exchange_(std::move(exchange)) {}

    std::size_t rows() const { return areas_.size(); }
    const std::vector<double>& areas() const { return areas_; }
    /// What it is kept as; nothing if it is not reciprocal by construction.
    const std::optional<ExchangeAreas>& exchange_areas() const { return exchange_; }

    /// Entries in ascending order of their columns. Threads may set different rows at once. Not for
    /// a matrix that is kept as exchange areas.
    void set_row(std::size_t i, std::vector<Entry> entries) { rows_[i] = std::move(entries); }
    /// The same from all of the row's factors; those above 0 are kept.
    void set_row(std::size_t i, std::span<const double> factors);

    /// Calls visit(i, entries of row i in ascending order) for every row in order.
    void for_rows(const std::function<void(std::size_t, std::span<const Entry>)>& visit) const;

    std::size_t bytes() const;

  private:
    std::vector<double> areas_;
    std::vector<std::vector<Entry>> rows_{};  ///< without exchange areas
    std::optional<ExchangeAreas> exchange_{};
};

/// S_ij from both A_i F_ij and A_j F_ji, each weighted by the inverse of its variance where factors
/// are equally wrong in every row: the smaller area counts more. What is kept as exchange areas is
/// returned as it is.
ExchangeAreas symmetrised(const FormFactorMatrix& F);

}  // namespace exitance
