// SPDX-License-Identifier: Apache-2.0
// The light operator without a matrix: rows and columns are computed when they are needed, used
// and forgotten.
#pragma once

#include <vector>

#include "exitance/transport/column.h"
#include "exitance/transport/element_caster.h"
#include "exitance/transport/transport.h"

namespace exitance {

struct OnTheFlyOptions {
    ColumnOptions column;
    float tolerance = 1;        ///< irradiance that may be wrong, for the rays of a column
    std::vector<float> weight;  ///< per column of a field: makes one number of it
};

/// A row by rays over the hemisphere of its element, the same ones in every sweep; a column by the
/// exact factor and the visible share at the Gauss points of all elements.
class OnTheFlyTransport final : public Transport {
  public:
    /// All arguments outlive the transport.
    OnTheFlyTransport(const ElementScene& scene, const ElementRows& rows, const RowPoints& points,
                      const ElementCaster& caster, OnTheFlyOptions options, double accuracy);

    std::size_t rows() const override { return rows_.size(); }
    void gather(const RowField& exitance, RowField& irradiance) override;
    void shoot(RowId from, std::span<const float> exitance, RowField& irradiance) override;
    bool symmetric() const override { return false; }
    double accuracy() const override { return accuracy_; }
    std::size_t bytes() const override {
        return points_.receivers.bytes() + everyone_.capacity() * sizeof(std::uint32_t) +
               entries_.capacity() * sizeof(ColumnEntry);
    }

  private:
    ElementScene scene_;
    const ElementRows& rows_;
    const RowPoints& points_;
    const ElementCaster& caster_;
    OnTheFlyOptions options_;
    double accuracy_;
    std::vector<std::uint32_t> everyone_;
    std::vector<ColumnEntry> entries_;
};

}  // namespace exitance
