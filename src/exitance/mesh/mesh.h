// SPDX-License-Identifier: Apache-2.0
// What is solved for: polygon sides are faces, faces are divided into patches (what shoots),
// patches are the roots of restricted quadtrees of elements, and the elements' corners are the
// vertices (where light is received).
//
// Places and vertices are apart: a `PositionId` is a place in space, made once in double from the
// original corners, so that all faces around it agree bit for bit; a `VertexId` is a place as part
// of one smooth surface, with a normal and its own light. Two walls that meet share positions; two
// coplanar triangles of one floor share vertices.
#pragma once

#include <tsl/robin_map.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "exitance/math/vector.h"
#include "exitance/mesh/ids.h"
#include "exitance/scene/scene.h"

namespace exitance {

/// One side of a polygon, or of a piece of one that contacts divide; divided into `columns` ×
/// `rows` patches (a triangle: `columns`² patches).
struct Face {
    PolygonId polygon;
    bool back = false;  ///< the reverse side of a two-sided polygon
    std::uint32_t surface = 0;
    std::uint32_t smooth = 0;  ///< faces with the same number share vertices
    std::uint32_t count = 4;   ///< corners
    std::array<PositionId, 4> corners;
    std::array<Vec3, 4> normals{};  ///< shading normals at the corners
    Vec3 normal;
    /// From corner i to i + 1: a part of an edge.
    struct Side {
        std::uint32_t edge = 0;
        std::int64_t begin = 0, end = 0;  ///< in steps of the edge's canonical direction
        /// Takes the place of `smooth` where something stands on the side; `smooth` if nothing
        /// does.
        std::uint32_t smooth = 0;
    };
    std::array<Side, 4> sides{};
    std::array<std::uint32_t, 4> corner_smooth{};  ///< the same of its corners
    std::uint32_t piece = 0;  ///< of a polygon that contacts divide; the same for both faces of one
    std::uint32_t columns = 1, rows = 1;
    PatchId first_patch;
};

struct Patch {
    FaceId face;
    ElementId root;
    double area = 0;  ///< [m²]
};

/// A node of a quadtree. Its corners in the integer coordinates of its face are (u, v) and steps of
/// `size` from there: quads (u,v) (u+s,v) (u+s,v+s) (u,v+s); triangles (u,v) (u+s,v) (u,v+s), with
/// s negative for the ones that point the other way.
struct Element {
    std::array<VertexId, 4> vertices;
    ElementId parent, first_child;  ///< four children in a row
    PatchId patch;
    std::int32_t u = 0, v = 0, size = 0;
    std::uint8_t level = 0, count = 4;
    float area = 0;  ///< [m²]

    bool leaf() const { return !first_child.valid(); }
    std::span<const VertexId> corners() const { return {vertices.data(), count}; }
};

struct Vertex {
    PositionId position;
    std::uint32_t smooth = 0;
    FaceId face;   ///< one of those it is a corner of
    Vec3f normal;  ///< unit
    Vec3
        sample;  ///< where irradiance is evaluated: `position`, or a hair inside at a face's border
};

/// How finely the scene is divided before any light is known.
struct MeshOptions {
    double patch_size = 0.5;  ///< longest patch edge where the file does not say [m]
    bool divide_as_file = true;
    /// Polygons are cut along contacts at least as long as this [m]: light may jump across them.
    double shortest_contact = 0.1;

    /// Contacts shorter than a sixteenth of a patch are left to the elements: light gets round what
    /// stands on them.
    static MeshOptions of_patches(double size) {
        MeshOptions out;
        out.patch_size = size;
        out.shortest_contact = 0.0625 * size;
        return out;
    }
};

class Mesh {
  public:
    /// Subdivision steps a patch can take: element coordinates are multiples of 2^-max_level
    /// patches.
    static constexpr int max_level = 12;

    Mesh(const Scene& scene, const MeshOptions& options);

    const std::vector<Vec3>& positions() const { return positions_; }
    const std::vector<Face>& faces() const { return faces_; }
    const std::vector<Patch>& patches() const { return patches_; }
    const std::vector<Element>& elements() const { return elements_; }
    const std::vector<Vertex>& vertices() const { return vertices_; }

    const Face& operator[](FaceId id) const { return faces_[id.index()]; }
    const Patch& operator[](PatchId id) const { return patches_[id.index()]; }
    const Element& operator[](ElementId id) const { return elements_[id.index()]; }
    const Vertex& operator[](VertexId id) const { return vertices_[id.index()]; }
    const Vec3& operator[](PositionId id) const { return positions_[id.index()]; }

    std::array<Vec3, 4> corners(const Face& face) const;
    std::array<Vec3, 4> corners(const Element& element) const;
    const Face& face_of(const Element& element) const {
        return (*this)[(*this)[element.patch].face];
    }

    /// Point of a face at integer coordinates, shading normal there.
    Vec3 point(const Face& face, std::int32_t u, std::int32_t v) const;
    Vec3 normal(const Face& face, std::int32_t u, std::int32_t v) const;

    /// Places inside `element` between its corners: edge midpoints in order, then the centre of a
    /// quad.
    struct Midpoints {
        std::array<std::array<std::int32_t, 2>, 5> at;
        std::uint32_t count;
    };
    static Midpoints midpoints(const Element& element);

    /// The existing vertex of the face's smooth surface at these coordinates.
    std::optional<VertexId> find_vertex(const Face& face, std::int32_t u, std::int32_t v) const;

    std::optional<VertexId> find_vertex(PositionId position, std::uint32_t smooth) const;

    /// Where irradiance would be evaluated for a midpoint of `element`.
    Vec3 sample_point(const Element& element, std::int32_t u, std::int32_t v) const;

    /// Divides a leaf 4-way, and first the coarser neighbours that would otherwise be two levels
    /// coarser (restricted quadtree). Returns every element that was split, coarse ones first.
    /// Nothing happens at `max_level`.
    std::vector<ElementId> split(ElementId leaf);

    /// Removes the children of `parent`, all leaves. Vertices stay and are no longer referred to.
    void merge(ElementId parent);

    /// Whether `parent`'s children are leaves and no neighbour is finer than they are.
    bool can_merge(ElementId parent) const;

    /// A place as part of a smooth surface.
    struct Between {
        PositionId position;
        std::uint32_t smooth;
    };
    /// Positions strictly between the ends of the side of `element` that runs from corner `side` to
    /// the next, in order, as far as `live` [one per position] says that they are used.
    void between(const Element& element, std::uint32_t side, const std::vector<char>& live,
                 std::vector<Between>& out) const;

    /// Calls `visit(ElementId)` for the leaves below `root`, in a fixed order.
    template <class Visit>
    void for_leaves(ElementId root, const Visit& visit) const {
        const Element& element = (*this)[root];
        if (element.leaf()) return visit(root);
        for (std::uint32_t c = 0; c < 4; ++c)
            for_leaves(ElementId(element.first_child.index() + c), visit);
    }

    std::size_t bytes() const;

  private:
    struct Key {
        std::uint64_t first, second;
        friend bool operator==(const Key&, const Key&) = default;
    };
    struct KeyHash {
        std::size_t operator()(const Key& key) const;
    };
    template <class Value>
    using Table = tsl::robin_map<Key, Value, KeyHash>;
    /// A straight line between two places along which faces meet. Places on it are counted in steps
    /// from the lower of its ends to the higher.
    struct Edge {
        std::array<PositionId, 2> ends;
        std::map<std::int64_t, PositionId> places;  ///< between the ends
        struct Contact {
            std::int64_t first, last;  ///< steps
            PolygonId polygon;         ///< that stands there
        };
        std::vector<Contact> contacts{};
    };
    static constexpr std::int64_t edge_steps = std::int64_t{1} << 40;
    struct EdgePlace {
        std::uint32_t side;  ///< of the face
        std::int64_t step;   ///< along the edge
    };

    /// How far along the edge of a side of the face a place is; nothing if it is not on that side.
    std::optional<std::int64_t> place_on(const Face& face, std::uint32_t side, std::int32_t u,
                                         std::int32_t v) const;
    std::optional<EdgePlace> edge_place(const Face& face, std::int32_t u, std::int32_t v) const;
    /// The smooth surface that a place of the face belongs to.
    std::uint32_t smooth_at(const Face& face, std::int32_t u, std::int32_t v) const;
    std::uint32_t smooth_at(const Face& face, std::uint32_t side, std::int64_t step) const;
    std::optional<std::uint32_t> corner_at(const Face& face, std::int32_t u, std::int32_t v) const;
    std::optional<PositionId> find_position(const Face& face, std::int32_t u, std::int32_t v) const;
    PositionId make_position(const Face& face, std::int32_t u, std::int32_t v);
    VertexId make_vertex(const Element& element, const Face& face, std::int32_t u, std::int32_t v);
    void make_corners(ElementId id);
    void register_edges(ElementId id, bool present);
    std::optional<ElementId> other_leaf(VertexId a, VertexId b, ElementId than) const;
    void split_into(ElementId leaf, std::vector<ElementId>& done);

    friend class MeshBuilder;

    std::vector<Vec3> positions_;
    std::vector<Face> faces_;
    std::vector<Patch> patches_;
    std::vector<Element> elements_;
    std::vector<Vertex> vertices_;

    std::vector<Edge> edges_;
    Table<PositionId> inside_;                   ///< (piece, u, v) → place
    Table<VertexId> vertex_at_;                  ///< (position, smooth) → vertex
    Table<std::array<ElementId, 2>> leaves_at_;  ///< (vertex, vertex) → leaves on that edge
    std::vector<ElementId> free_children_;       ///< slots of merged children
};

}  // namespace exitance
