// SPDX-License-Identifier: Apache-2.0
// The light operator H = F B between the elements of a mesh, as solvers of the linear system use
// it: all rows at once (gather), or one column (shoot).
#pragma once

#include <cstdint>
#include <span>

#include "exitance/mesh/field.h"

namespace exitance {

/// Work done so far.
struct TransportCounters {
    std::uint64_t gathers = 0, shots = 0, rays = 0;
};

/// All columns of a field (light groups × bands) pass through at once. Results do not depend on the
/// number of threads.
class Transport {
  public:
    virtual ~Transport() = default;

    virtual std::size_t rows() const = 0;
    /// `irradiance` = F · `exitance`.
    virtual void gather(const RowField& exitance, RowField& irradiance) = 0;
    /// `irradiance` += column `from` of F times `exitance` [one row of a field].
    virtual void shoot(RowId from, std::span<const float> exitance, RowField& irradiance) = 0;
    /// Whether gather() and shoot() are one operator with A_i F_ij = A_j F_ji to the last bit.
    virtual bool symmetric() const = 0;
    /// Whether every product is another sample of F, right on average.
    virtual bool random() const { return false; }
    /// Error to expect of the irradiance of a row, as a share of it, where what it sees is uneven.
    virtual double accuracy() const = 0;
    /// What is stored.
    virtual std::size_t bytes() const = 0;

    const TransportCounters& counters() const { return counters_; }

  protected:
    TransportCounters counters_;
};

}  // namespace exitance
