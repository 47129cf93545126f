// SPDX-License-Identifier: Apache-2.0
// The light operator as links between nodes of a hierarchy, each where the light it carries is
// even enough (Hanrahan, Salzman & Aupperle 1991, "A rapid hierarchical radiosity algorithm").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/mesh/clusters.h"
#include "exitance/transport/element_rows.h"
#include "exitance/transport/link_exchange.h"
#include "exitance/transport/transport.h"

namespace exitance {

/// The nodes above the rows of a linear system: what rows send is pulled up to every node, what
/// nodes receive is pushed down to the rows.
class LinkNodes {
  public:
    /// Rows are the leaves of the clusters' mesh, in any order.
    LinkNodes(const Clusters& clusters, const ElementRows& rows);

    /// Of all nodes; a cluster's or element's number in the fields below.
    std::size_t size() const { return order_.size(); }
    std::size_t position(NodeId node) const { return position_[node.index()]; }
    NodeId node(std::size_t position) const { return order_[position]; }
    /// Open area [m²].
    double area(std::size_t position) const { return area_[position]; }

    /// Flux of each node, size() × stride values. `scale`: of each row's exitance; none if empty.
    void pull(const RowField& exitance, std::span<const float> scale,
              std::vector<float>& flux) const;
    /// Adds up what a row's nodes have received, from the root to itself, and adds it, scaled, to
    /// `irradiance`. `received`: size() × stride values, used up.
    void push(std::vector<float>& received, std::span<const float> scale,
              RowField& irradiance) const;
    /// Calls `visit(position)` for the node of a row and all above it.
    template <class Visit>
    void for_ancestors(RowId row, const Visit& visit) const {
        for (std::uint32_t k = of_row_[row.index()];; k = parent_[k]) {
            visit(std::size_t{k});
            if (k == 0) return;
        }
    }
    std::size_t bytes() const;

  private:
    static constexpr std::uint32_t none = 0xffffffffu;
    std::vector<NodeId> order_;            ///< parents before their children
    std::vector<std::uint32_t> position_;  ///< per node
    std::vector<std::uint32_t> parent_;    ///< per position
    std::vector<std::uint32_t> row_;       ///< per position; none above the leaves
    std::vector<std::uint32_t> of_row_;    ///< position of each row
    std::vector<float> row_area_;
    std::vector<double> area_;
};

/// H = F B by links: pull, one product per link and direction, push. Symmetric as the links are.
class LinkTransport final : public Transport {
  public:
    /// `nodes` outlives the transport.
    LinkTransport(const LinkNodes& nodes, std::span<const Link> links, std::size_t rows,
                  double accuracy);

    /// Scales rows, symmetrically, until each adds up to `wanted`, what it sees of the scene
    /// [0 … 1]: one value per node is right on average over the node, and this makes the sums right
    /// row by row, so that nothing is lost or made in a closed room. Rows of which nothing is
    /// wanted stay.
    void scale_to(std::span<const float> wanted);

    std::size_t rows() const override { return rows_; }
    void gather(const RowField& exitance, RowField& irradiance) override;
    void shoot(RowId from, std::span<const float> exitance, RowField& irradiance) override;
    bool symmetric() const override { return true; }
    double accuracy() const override { return accuracy_; }
    std::size_t bytes() const override {
        return nodes_.bytes() + begin_.capacity() * sizeof(std::size_t) +
               partner_.capacity() * sizeof(std::uint32_t) + share_.capacity() * sizeof(float);
    }

  private:
    const LinkNodes& nodes_;
    std::size_t rows_;
    double accuracy_;
    std::vector<std::size_t> begin_;      ///< per position: its links, and the end
    std::vector<std::uint32_t> partner_;  ///< position of the other end
    std::vector<float> scale_;            ///< per row; empty: none
    std::vector<float> share_;  ///< S / (A_a A_b): of the partner's flux, as irradiance [1/m²]
};

}  // namespace exitance
