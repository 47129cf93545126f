// SPDX-License-Identifier: Apache-2.0
// A hierarchy over patches, so that light between far things need not be looked at patch by patch:
// face clusters, patches of one flat surface, and volume clusters, whatever lies near together
// (Smits, Arvo & Greenberg 1994; Sillion 1995). It goes on below the patches as the quadtrees of
// elements do: both together are the nodes that links connect.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "exitance/math/box.h"
#include "exitance/math/small_polygon.h"
#include "exitance/mesh/mesh.h"

namespace exitance {

using NodeId = Id<struct NodeTag>;  ///< a cluster, or an element

/// A place on a face.
struct FacePlace {
    Vec3 at;
    FaceId face;
};

struct Cluster {
    static constexpr std::size_t places_count = 8;

    std::array<NodeId, 2> children;
    Box box;
    std::optional<Plane> plane;  ///< of a face cluster
    double area = 0;             ///< [m²]
    /// Spread over what is in it by area, each for an equal share.
    std::array<FacePlace, places_count> places;
};

class Clusters {
  public:
    /// `mesh` outlives the clusters and may be divided further.
    explicit Clusters(const Mesh& mesh);

    /// Of all nodes; numbers of elements, and with them this, grow as the mesh is divided.
    std::size_t nodes() const { return clusters_.size() + mesh_.elements().size(); }
    /// Everything: a cluster, or the only element there is.
    NodeId root() const { return root_; }

    bool is_cluster(NodeId node) const { return node.index() < clusters_.size(); }
    const Cluster& cluster(NodeId node) const { return clusters_[node.index()]; }
    ElementId element(NodeId node) const { return ElementId(node.index() - clusters_.size()); }
    NodeId node(ElementId element) const { return NodeId(element.index() + clusters_.size()); }

    std::size_t child_count(NodeId node) const {
        return is_cluster(node) ? 2 : mesh_[element(node)].leaf() ? 0 : 4;
    }
    NodeId child(NodeId parent, std::size_t c) const {
        if (is_cluster(parent)) return cluster(parent).children[c];
        return node(ElementId(mesh_[element(parent)].first_child.index() + c));
    }

    std::size_t bytes() const { return clusters_.capacity() * sizeof(Cluster); }

  private:
    struct Part {
        NodeId node;
        Box box;
        double area;
    };
    Part of_patch(const Patch& patch) const;
    Part join(std::vector<Part>& parts, std::size_t begin, std::size_t end);
    FacePlace place_in(NodeId node, std::array<double, 2> u) const;
    double area_of(NodeId node) const;
    std::optional<Plane> plane_of(NodeId node, double slack) const;

    const Mesh& mesh_;
    std::size_t patches_ = 0;
    std::vector<Cluster> clusters_;
    NodeId root_;
};

}  // namespace exitance
