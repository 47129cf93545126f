// SPDX-License-Identifier: Apache-2.0
// The light operator as a stored matrix of which only what is not zero is kept.
#pragma once

#include <cstdint>
#include <vector>

#include "exitance/formfactor/exchange_areas.h"
#include "exitance/transport/transport.h"

namespace exitance {

/// Both triangles of the exchange areas S = A F, compressed by rows: a row is a column, too.
class SparseTransport final : public Transport {
  public:
    /// Takes `areas` over. `area` of each row [m²]; rows without area get no light.
    SparseTransport(ExchangeAreas areas, std::vector<float> area, double accuracy);

    std::size_t rows() const override { return area_.size(); }
    void gather(const RowField& exitance, RowField& irradiance) override;
    void shoot(RowId from, std::span<const float> exitance, RowField& irradiance) override;
    bool symmetric() const override { return true; }
    double accuracy() const override { return accuracy_; }
    std::size_t bytes() const override {
        return begin_.capacity() * sizeof(std::size_t) +
               column_.capacity() * sizeof(std::uint32_t) + exchange_.capacity() * sizeof(float);
    }

  private:
    std::vector<std::size_t> begin_;
    std::vector<std::uint32_t> column_;  ///< ascending in each row
    std::vector<float> exchange_;        ///< S_ij [m²]
    std::vector<float> area_;
    double accuracy_;
};

}  // namespace exitance
