// SPDX-License-Identifier: Apache-2.0
// The light operator by fresh rays in every product, as many from an element as it has power to
// distribute: the rays of stochastic Jacobi iteration (Neumann 1995, "Monte Carlo radiosity";
// Bekaert 1999, "Hierarchical and stochastic algorithms for radiosity", ch. 6).
#pragma once

#include <vector>

#include "exitance/transport/element_caster.h"
#include "exitance/transport/transport.h"

namespace exitance {

struct StochasticRaysOptions {
    double rays_per_row = 64;   ///< on average, in the product that distributes most power
    std::vector<float> weight;  ///< per column of a field: makes one number of it
    std::uint64_t seed = 0;
};

/// Elements shoot: packets of sixteen rays from a place each, which carry all columns to where they
/// end. Places and directions of an element go on along their low-discrepancy sequences from
/// product to product, so that the mean of products is stratified too. Nothing is stored but where
/// each is. Every product is right on average.
class StochasticRays final : public Transport {
  public:
    /// `rows` and `caster` outlive the transport.
    StochasticRays(const ElementScene& scene, const ElementRows& rows, const ElementCaster& caster,
                   StochasticRaysOptions options);

    std::size_t rows() const override { return rows_.size(); }
    void gather(const RowField& exitance, RowField& irradiance) override;
    void shoot(RowId from, std::span<const float> exitance, RowField& irradiance) override;
    bool symmetric() const override { return false; }
    bool random() const override { return true; }
    double accuracy() const override;
    std::size_t bytes() const override { return next_.capacity() * sizeof(std::uint32_t); }

  private:
    /// Packets that one row sends in a product, and for how many each of them stands.
    struct Shooter {
        std::uint32_t row, packets;
        float stands_for;
    };
    double power(std::size_t row, std::span<const float> exitance) const;
    /// Sixteen rays from place `packet` of those spread over the row; false where it is not open.
    bool cast(std::size_t row, std::uint32_t packet, ElementCaster::Ends& ends) const;
    void send(std::span<const Shooter> shooters, const RowField& exitance, RowField& irradiance);

    ElementScene scene_;
    const ElementRows& rows_;
    const ElementCaster& caster_;
    StochasticRaysOptions options_;
    double most_power_ = 0;            ///< that a product had to distribute
    std::vector<std::uint32_t> next_;  ///< per row: packets sent so far
};

}  // namespace exitance
