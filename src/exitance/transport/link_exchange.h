// SPDX-License-Identifier: Apache-2.0
// What two nodes of the hierarchy exchange, how even it is over each of them, and how much of it
// gets past what stands between.
#pragma once

#include <cstdint>
#include <vector>

#include "exitance/math/box_tree.h"
#include "exitance/mesh/clusters.h"
#include "exitance/transport/element_rows.h"
#include "exitance/visibility/blocker.h"
#include "exitance/visibility/shaft.h"

namespace exitance {

/// An exchange of light between two nodes, both ways.
struct Link {
    NodeId a, b;
    float area = 0;  ///< S_ab = A_a F_ab = A_b F_ba [m²]
    /// Standard deviation of the factor of a place on a to all of b, over the places; and of b.
    /// Places that see others than the sampled ones count into it.
    float spread_a = 0, spread_b = 0;
    /// By how much the factor of each place of a, of its Gauss points if it is an element, departs
    /// from their mean; and of b.
    std::array<float, Cluster::places_count> off_a{}, off_b{};
    bool bound = false;  ///< too near to be measured: `area` is a guess, the spreads are bounds
};

/// How a link between two nodes came out.
enum class Meeting {
    none,   ///< they turn away from each other, or something hides all
    seen,   ///< nothing is between
    partly  ///< rays told
};

class LinkExchange {
  public:
    /// All arguments outlive this.
    LinkExchange(const ElementScene& scene, const Clusters& clusters, std::uint64_t seed);

    /// Measures a link between nodes of open areas `open_a` and `open_b`. Two elements: exact
    /// factors, polygons that touch included; else the kernel between eight places of either. What
    /// is between is found by the shaft of the two boxes; rays are cast only where that leaves it
    /// open. Threads may measure at once.
    Meeting measure(NodeId a, NodeId b, double open_a, double open_b, Link& link,
                    std::uint64_t& rays) const;

    std::size_t bytes() const;

  private:
    struct End;
    End end_of(NodeId node, double open) const;
    Meeting between(const End& a, const End& b) const;
    struct Look;
    /// Rays between all pairs of places that face each other.
    void cast(const End& a, const End& b, Look& look) const;

    ElementScene scene_;
    const Clusters& clusters_;
    std::uint64_t seed_;
    double scale_ = 1;               ///< blockers and shafts are in diagonals of the scene …
    Vec3 middle_;                    ///< … around its middle
    std::vector<Blocker> blockers_;  ///< but for glass, through which some light goes
    std::vector<BoxTree> tree_;      ///< over the blockers; one, or none if nothing blocks
};

}  // namespace exitance
