// SPDX-License-Identifier: Apache-2.0
// A radiosity field is a matrix: one row per vertex, element or patch, one column per
// (light group × band). Column = group · bands + band.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "exitance/mesh/ids.h"

namespace exitance {

/// Number of columns rounded up so that a row fills whole SIMD registers; the padding stays zero.
constexpr std::size_t padded_columns(std::size_t columns) {
    const std::size_t lanes = columns <= 4 ? 4 : columns <= 8 ? 8 : 16;
    return (columns + lanes - 1) / lanes * lanes;
}

template <class RowId>
class Field {
  public:
    Field() = default;
    Field(std::size_t rows, std::size_t columns)
        : columns_(columns), stride_(padded_columns(columns)), values_(rows * stride_, 0.0f) {}

    std::size_t rows() const { return stride_ ? values_.size() / stride_ : 0; }
    std::size_t columns() const { return columns_; }
    std::size_t stride() const { return stride_; }
    std::size_t bytes() const { return values_.capacity() * sizeof(float); }

    /// New rows are zero.
    void resize_rows(std::size_t rows) { values_.resize(rows * stride_, 0.0f); }

    /// The row with its padding: `stride()` values.
    std::span<float> operator[](RowId id) { return {&values_[id.index() * stride_], stride_}; }
    std::span<const float> operator[](RowId id) const {
        return {&values_[id.index() * stride_], stride_};
    }
    std::span<const float> values() const { return values_; }

  private:
    std::size_t columns_ = 0, stride_ = 0;
    std::vector<float> values_;
};

using VertexField = Field<VertexId>;
using ElementField = Field<ElementId>;
using PatchField = Field<PatchId>;
using RowField = Field<RowId>;

}  // namespace exitance
