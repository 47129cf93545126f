// SPDX-License-Identifier: Apache-2.0
// The light operator as a stored matrix without gaps.
#pragma once

#include <vector>

#include "exitance/formfactor/exchange_areas.h"
#include "exitance/transport/transport.h"

namespace exitance {

/// Exchange areas S = A F, of which the lower triangle is kept: half the memory of F. A gather
/// goes through it in square tiles, so that a row of fields that is in cache serves a tile's
/// rows.
class DenseTransport final : public Transport {
  public:
    /// Takes `areas` over, row by row. `area` of each row [m²]; rows without area get no light.
    DenseTransport(ExchangeAreas areas, std::vector<float> area, double accuracy);

    std::size_t rows() const override { return area_.size(); }
    void gather(const RowField& exitance, RowField& irradiance) override;
    void shoot(RowId from, std::span<const float> exitance, RowField& irradiance) override;
    bool symmetric() const override { return true; }
    double accuracy() const override { return accuracy_; }
    std::size_t bytes() const override { return triangle_.capacity() * sizeof(float); }

    static std::size_t bytes_for(std::size_t rows) { return rows * (rows + 1) / 2 * sizeof(float); }

  private:
    const float* row(std::size_t i) const { return &triangle_[i * (i + 1) / 2]; }

    std::vector<float> triangle_;  ///< S_00 S_10 S_11 S_20 …
    std::vector<float> area_;
    double accuracy_;
};

}  // namespace exitance
