// SPDX-License-Identifier: Apache-2.0
// Links and elements divided where the light says so: refine with what is reflected now, gather
// over the links, refine again (Hanrahan, Salzman & Aupperle 1991: brightness, factor, area).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "exitance/mesh/clusters.h"
#include "exitance/solve/radiosity.h"
#include "exitance/transport/column.h"
#include "exitance/transport/links.h"

namespace exitance {

class LinkRefinement;

struct LinkOptions {
    double error = 0.02;  ///< RMS error of irradiance, relative to its mean, within all elements
    float tolerance = 0;  ///< irradiance (luminance) that does not matter, for the lamps' rays
    float min_area = 0;   ///< elements below this area stay [m²]
    bool divide = true;   ///< elements; else links end at the elements there are
    ColumnOptions column;
    /// Asked again and again with the rays cast so far; false: links stay as they are.
    std::function<bool(std::uint64_t rays)> go_on{};
    std::function<void(const LinkRefinement&)> each_round{};
};

/// What one value per node leaves of the irradiance that its links bring it, Σ B · departure of F
/// from its mean at places of the node, is gathered as irradiance is: pushed down, its squares add
/// up to that of the error E of each element. The links that contribute most to Σ A E² are replaced
/// by links of the children of one end, again and again, until that is the square of the error
/// asked for. The light of the lamps is in none of the links; elements on which it is uneven are
/// divided by the same rule.
class LinkRefinement {
  public:
    LinkRefinement(Radiosity& radiosity, const ElementScene& scene, LinkOptions options);

    /// Refines for `reflected` [one row per row of rows(); if empty, what one reflection of the
    /// lamps and an ambient guess would give]. False if there was nothing to do.
    bool refine(const RowField& reflected);

    /// Leaves of the mesh as it is now, and the lamps' light on them.
    const ElementRows& rows() const { return rows_; }
    RowField direct() const;
    /// D and what the links have brought so far, and R for it.
    RowField irradiance() const;
    RowField reflected() const;
    /// Whether these two are better than the lamps' light alone; at first R is an ambient guess.
    bool worth_showing() const { return worth_showing_; }
    std::unique_ptr<LinkTransport> transport() const;

    std::size_t links() const { return links_.size(); }
    std::uint64_t rays() const { return rays_; }
    /// Of links, clusters and blockers; not of the transport made from them.
    std::size_t bytes() const {
        return links_.capacity() * sizeof(Link) + clusters_.bytes() + exchange_.bytes();
    }

  private:
    /// Per position in the nodes.
    struct State {
        std::vector<float> mean, deviation;  ///< of what is reflected (Columns::magnitude)
        std::vector<float> error;            ///< E [irradiance], root of its mean square
        double total = 0;                    ///< Σ A E² [m² · irradiance²]
    };
    /// Irradiance that is wrong on either end of a link, and what of it dividing that end would
    /// mend on both.
    struct Fault {
        double on_a = 0, on_b = 0;
        double by_a_on_a = 0, by_a_on_b = 0, by_b_on_b = 0;
    };
    struct Pair {
        NodeId a, b;
    };

    RowField of_rows(const ElementField& field) const;
    void admit_leaves(const std::vector<ElementId>& leaves);
    void find_rows();
    void reflect();
    void gather();
    void guess_ambient();
    State state() const;
    Fault fault(const Link& link, const State& state) const;
    double lamps_fault(ElementId leaf) const;
    bool can_divide(NodeId node) const;
    bool can_divide(const Link& link) const { return can_divide(link.a) || can_divide(link.b); }
    bool divide_a(const Link& link, const State& state) const;
    bool replace_links(double threshold, const State& state);
    bool measure(const std::vector<Pair>& pairs);
    bool divide_elements(double threshold, const State& state);
    double allowed() const;

    Radiosity& radiosity_;
    ElementScene scene_;
    LinkOptions options_;
    Clusters clusters_;
    LinkExchange exchange_;
    std::vector<Link> links_;
    bool begun_ = false, gathered_ = false, worth_showing_ = false;

    ElementField direct_, received_, reflected_;  ///< per leaf: D, F R, R
    std::vector<float> uneven_;                   ///< per leaf: standard deviation of D
    std::vector<float> area_;                     ///< per leaf: open [m²]
    ElementRows rows_;
    std::unique_ptr<LinkNodes> nodes_;
    std::vector<ElementId> wanted_;  ///< to be divided
    std::uint64_t rays_ = 0;
};

}  // namespace exitance
