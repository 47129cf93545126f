// SPDX-License-Identifier: Apache-2.0
// Places, vertices and the quadtree.
#include "exitance/mesh/mesh.h"

#include <algorithm>
#include <cmath>

#include "exitance/math/polygon.h"
#include "exitance/run/random.h"

namespace exitance {

namespace {

constexpr std::int32_t unit = 1 << Mesh::max_level;

// Evaluation points on a face's border move this share of the way to the middle of their element:
// irradiance in a corner is the limit from inside.
constexpr double border_inset = 1e-3;

Mesh::Midpoints element_corners(const Element& e) {
    const std::int32_t s = e.size;
    if (e.count == 4)
        return {{{{e.u, e.v}, {e.u + s, e.v}, {e.u + s, e.v + s}, {e.u, e.v + s}, {}}}, 4};
    return {{{{e.u, e.v}, {e.u + s, e.v}, {e.u, e.v + s}, {}, {}}}, 3};
}

}  // namespace

std::size_t Mesh::KeyHash::operator()(const Key& key) const {
    return static_cast<std::size_t>(hash_bits(key.first * 0x9e3779b97f4a7c15ULL ^ key.second));
}

std::array<Vec3, 4> Mesh::corners(const Face& face) const {
    std::array<Vec3, 4> out;
    for (std::uint32_t i = 0; i < face.count; ++i) out[i] = (*this)[face.corners[i]];
    return out;
}

std::array<Vec3, 4> Mesh::corners(const Element& element) const {
    std::array<Vec3, 4> out;
    for (std::uint32_t i = 0; i < element.count; ++i)
        out[i] = (*this)[(*this)[element.vertices[i]].position];
    return out;
}

std::optional<std::uint32_t> Mesh::corner_at(const Face& face, std::int32_t u,
                                             std::int32_t v) const {
    const std::int32_t U = static_cast<std::int32_t>(face.columns) * unit;
    const std::int32_t V = static_cast<std::int32_t>(face.rows) * unit;
    if (u == 0 && v == 0) return 0;
    if (u == U && v == 0) return 1;
    if (face.count == 4 && u == U && v == V) return 2;
    if (u == 0 && v == V) return face.count == 4 ? 3 : 2;
    return std::nullopt;
}

std::optional<std::int64_t> Mesh::place_on(const Face& face, std::uint32_t side, std::int32_t u,
                                           std::int32_t v) const {
    const std::int32_t U = static_cast<std::int32_t>(face.columns) * unit;
    const std::int32_t V = static_cast<std::int32_t>(face.rows) * unit;
    const bool quad = face.count == 4;
    std::int32_t off, along, length;  // off: 0 on the side
    switch (side) {
        case 0:
            off = v, along = u, length = U;
            break;
        case 1:
            off = quad ? U - u : U - u - v, along = v, length = V;
            break;
        case 2:
            off = quad ? V - v : u, along = quad ? U - u : V - v, length = quad ? U : V;
            break;
        default:
            off = u, along = V - v, length = V;
    }
    if (off != 0) return std::nullopt;
    // From the side's lower end whichever way the face runs, so that all faces agree.
    const auto [edge, begin, end, smooth] = face.sides[side];
    if (begin > end) along = length - along;
    const std::int64_t low = std::min(begin, end), high = std::max(begin, end);
    return low +
           std::llround(static_cast<double>(high - low) * (static_cast<double>(along) / length));
}

std::optional<Mesh::EdgePlace> Mesh::edge_place(const Face& face, std::int32_t u,
                                                std::int32_t v) const {
    for (std::uint32_t side = 0; side < face.count; ++side)
        if (const auto step = place_on(face, side, u, v)) return EdgePlace{side, *step};
    return std::nullopt;
}

std::uint32_t Mesh::smooth_at(const Face& face, std::uint32_t side, std::int64_t step) const {
    const Face::Side& along = face.sides[side];
    if (along.smooth == face.smooth) return face.smooth;
    for (const Edge::Contact& contact : edges_[along.edge].contacts)
        if (contact.first <= step && step <= contact.last) return along.smooth;
    return face.smooth;
}

std::uint32_t Mesh::smooth_at(const Face& face, std::int32_t u, std::int32_t v) const {
    if (const auto corner = corner_at(face, u, v)) return face.corner_smooth[*corner];
    for (std::uint32_t side = 0; side < face.count; ++side)
        if (face.sides[side].smooth != face.smooth)
            if (const auto step = place_on(face, side, u, v)) return smooth_at(face, side, *step);
    return face.smooth;
}

namespace {

// Interior places are keyed by the polygon's own coordinates, so that both sides of a two-sided
// polygon agree: the reverse side counts its corners backwards (3 2 1 0, or 2 1 0).
std::array<std::uint32_t, 2> polygon_coordinates(const Face& face, std::int32_t u, std::int32_t v) {
    const std::int32_t U = static_cast<std::int32_t>(face.columns) * unit;
    const std::int32_t V = static_cast<std::int32_t>(face.rows) * unit;
    if (face.back) {
        if (face.count == 4)
            v = V - v;
        else
            v = U - u - v;
    }
    return {static_cast<std::uint32_t>(u), static_cast<std::uint32_t>(v)};
}

}  // namespace

Vec3 Mesh::point(const Face& face, std::int32_t u, std::int32_t v) const {
    if (const auto corner = corner_at(face, u, v)) return (*this)[face.corners[*corner]];
    if (const auto place = edge_place(face, u, v)) {
        const auto& [low, high] = edges_[face.sides[place->side].edge].ends;
        const double t = static_cast<double>(place->step) / edge_steps;
        return (*this)[low] + ((*this)[high] - (*this)[low]) * t;
    }
    // Bilinear or barycentric over the corners in the polygon's own order.
    const auto [pu, pv] = polygon_coordinates(face, u, v);
    const double s = static_cast<double>(pu) / (static_cast<double>(face.columns) * unit);
    const double t = static_cast<double>(pv) / (static_cast<double>(face.rows) * unit);
    std::array<Vec3, 4> c = corners(face);
    if (face.back) std::reverse(c.begin(), c.begin() + face.count);
    if (face.count == 3) return c[0] + (c[1] - c[0]) * s + (c[2] - c[0]) * t;
    return (c[0] * (1 - s) + c[1] * s) * (1 - t) + (c[3] * (1 - s) + c[2] * s) * t;
}

Vec3 Mesh::normal(const Face& face, std::int32_t u, std::int32_t v) const {
    std::array<Vec3, 4> n = face.normals;
    for (std::uint32_t i = 0; i < face.count; ++i)
        if (n[i] == Vec3{}) n[i] = face.normal;
    const double s = static_cast<double>(u) / (static_cast<double>(face.columns) * unit);
    const double t = static_cast<double>(v) / (static_cast<double>(face.rows) * unit);
    if (face.count == 3) return normalized(n[0] * (1 - s - t) + n[1] * s + n[2] * t);
    return normalized((n[0] * (1 - s) + n[1] * s) * (1 - t) + (n[3] * (1 - s) + n[2] * s) * t);
}

Mesh::Midpoints Mesh::midpoints(const Element& element) {
    const std::int32_t h = element.size / 2, u = element.u, v = element.v;
    if (element.count == 4)
        return {{{{u + h, v}, {u + 2 * h, v + h}, {u + h, v + 2 * h}, {u, v + h}, {u + h, v + h}}},
                5};
    return {{{{u + h, v}, {u + h, v + h}, {u, v + h}, {}, {}}}, 3};
}

std::optional<PositionId> Mesh::find_position(const Face& face, std::int32_t u,
                                              std::int32_t v) const {
    if (const auto corner = corner_at(face, u, v)) return face.corners[*corner];
    if (const auto place = edge_place(face, u, v)) {
        const auto& places = edges_[face.sides[place->side].edge].places;
        const auto found = places.find(place->step);
        return found == places.end() ? std::nullopt : std::optional(found->second);
    }
    const auto [pu, pv] = polygon_coordinates(face, u, v);
    const auto found = inside_.find({face.piece, std::uint64_t{pu} << 32 | pv});
    return found == inside_.end() ? std::nullopt : std::optional(found->second);
}

PositionId Mesh::make_position(const Face& face, std::int32_t u, std::int32_t v) {
    if (const auto known = find_position(face, u, v)) return *known;
    const PositionId id(positions_.size());
    positions_.push_back(point(face, u, v));
    if (const auto place = edge_place(face, u, v)) {
        edges_[face.sides[place->side].edge].places.emplace(place->step, id);
    } else {
        const auto [pu, pv] = polygon_coordinates(face, u, v);
        inside_.insert({{face.piece, std::uint64_t{pu} << 32 | pv}, id});
    }
    return id;
}

std::optional<VertexId> Mesh::find_vertex(const Face& face, std::int32_t u, std::int32_t v) const {
    const auto position = find_position(face, u, v);
    return position ? find_vertex(*position, smooth_at(face, u, v)) : std::nullopt;
}

std::optional<VertexId> Mesh::find_vertex(PositionId position, std::uint32_t smooth) const {
    const auto found = vertex_at_.find({position.value, smooth});
    return found == vertex_at_.end() ? std::nullopt : std::optional(found->second);
}

Vec3 Mesh::sample_point(const Element& element, std::int32_t u, std::int32_t v) const {
    const Face& face = face_of(element);
    const Vec3 p = point(face, u, v);
    if (!edge_place(face, u, v)) return p;
    Vec3 middle;
    const Midpoints around = element_corners(element);
    for (std::uint32_t i = 0; i < around.count; ++i)
        middle += point(face, around.at[i][0], around.at[i][1]) / static_cast<double>(around.count);
    return p + (middle - p) * border_inset;
}

VertexId Mesh::make_vertex(const Element& element, const Face& face, std::int32_t u,
                           std::int32_t v) {
    const PositionId position = make_position(face, u, v);
    const std::uint32_t smooth = smooth_at(face, u, v);
    const auto [slot, fresh] =
        vertex_at_.insert({{position.value, smooth}, VertexId(vertices_.size())});
    const VertexId id = slot->second;
    if (fresh)
        vertices_.push_back({position, smooth, (*this)[element.patch].face,
                             Vec3f(normal(face, u, v)), sample_point(element, u, v)});
    return id;
}

void Mesh::make_corners(ElementId id) {
    Element element = (*this)[id];
    const Face& face = face_of(element);
    const Midpoints at = element_corners(element);
    for (std::uint32_t i = 0; i < at.count; ++i)
        element.vertices[i] = make_vertex(element, face, at.at[i][0], at.at[i][1]);
    const auto c = corners(element);
    element.area = static_cast<float>(area({c.data(), element.count}));
    elements_[id.index()] = element;
    register_edges(id, true);
}

void Mesh::register_edges(ElementId id, bool present) {
    const Element& element = (*this)[id];
    for (std::uint32_t i = 0; i < element.count; ++i) {
        const VertexId a = element.vertices[i], b = element.vertices[(i + 1) % element.count];
        auto& leaves = leaves_at_[{std::min(a, b).value, std::max(a, b).value}];
        const ElementId from = present ? ElementId{} : id, to = present ? id : ElementId{};
        auto slot = std::find(leaves.begin(), leaves.end(), from);
        if (slot != leaves.end()) *slot = to;
        if (!leaves[0].valid() && !leaves[1].valid())
            leaves_at_.erase({std::min(a, b).value, std::max(a, b).value});
    }
}

std::optional<ElementId> Mesh::other_leaf(VertexId a, VertexId b, ElementId than) const {
    const auto found = leaves_at_.find({std::min(a, b).value, std::max(a, b).value});
    if (found == leaves_at_.end()) return std::nullopt;
    for (const ElementId leaf : found->second)
        if (leaf.valid() && leaf != than) return leaf;
    return std::nullopt;
}

std::vector<ElementId> Mesh::split(ElementId leaf) {
    std::vector<ElementId> done;
    split_into(leaf, done);
    return done;
}

void Mesh::split_into(ElementId id, std::vector<ElementId>& done) {
    if (!(*this)[id].leaf() || (*this)[id].level >= max_level) return;
    // A neighbour that spans the whole side of our parent is coarser than we are: it goes first.
    if (const ElementId parent = (*this)[id].parent; parent.valid()) {
        const Element above = (*this)[parent];
        for (std::uint32_t i = 0; i < above.count; ++i)
            if (const auto coarse =
                    other_leaf(above.vertices[i], above.vertices[(i + 1) % above.count], parent))
                split_into(*coarse, done);
    }
    if (!(*this)[id].leaf()) return;
    register_edges(id, false);
    const Element e = (*this)[id];
    const std::int32_t h = e.size / 2;
    ElementId first(elements_.size());
    if (!free_children_.empty()) {
        first = free_children_.back();
        free_children_.pop_back();
    } else {
        elements_.resize(elements_.size() + 4);
    }
    elements_[id.index()].first_child = first;
    const bool quad = e.count == 4;
    const std::array<std::array<std::int32_t, 3>, 4> places{
        {{e.u, e.v, h},
         {e.u + h, e.v, h},
         quad ? std::array{e.u + h, e.v + h, h} : std::array{e.u, e.v + h, h},
         quad ? std::array{e.u, e.v + h, h} : std::array{e.u + h, e.v + h, -h}}};
    for (std::uint32_t c = 0; c < 4; ++c) {
        Element child;
        child.parent = id;
        child.patch = e.patch;
        child.u = places[c][0], child.v = places[c][1], child.size = places[c][2];
        child.level = static_cast<std::uint8_t>(e.level + 1);
        child.count = e.count;
        elements_[first.index() + c] = child;
        make_corners(ElementId(first.index() + c));
    }
    done.push_back(id);
}

bool Mesh::can_merge(ElementId parent) const {
    const Element& above = (*this)[parent];
    if (above.leaf()) return false;
    for (std::uint32_t c = 0; c < 4; ++c) {
        const ElementId id(above.first_child.index() + c);
        const Element& child = (*this)[id];
        if (!child.leaf()) return false;
        // A finer neighbour has split the child's side: its midpoint is a vertex of leaves there.
        const Face& face = face_of(child);
        const Midpoints middle = midpoints(child);
        for (std::uint32_t i = 0; i < child.count; ++i) {
            const auto vertex = find_vertex(face, middle.at[i][0], middle.at[i][1]);
            if (vertex && leaves_at_.contains({std::min(child.vertices[i], *vertex).value,
                                               std::max(child.vertices[i], *vertex).value}))
                return false;
        }
    }
    return true;
}

void Mesh::merge(ElementId parent) {
    const ElementId first = (*this)[parent].first_child;
    for (std::uint32_t c = 0; c < 4; ++c) register_edges(ElementId(first.index() + c), false);
    elements_[parent.index()].first_child = {};
    register_edges(parent, true);
    free_children_.push_back(first);
}

void Mesh::between(const Element& element, std::uint32_t side, const std::vector<char>& live,
                   std::vector<Between>& out) const {
    const Face& face = face_of(element);
    const Midpoints at = element_corners(element);
    const auto a = at.at[side], b = at.at[(side + 1) % at.count];

    // On the border of the face: whatever any face around this input edge has put there.
    for (std::uint32_t border = 0; border < face.count; ++border) {
        const auto from = place_on(face, border, a[0], a[1]);
        const auto to = place_on(face, border, b[0], b[1]);
        if (!from || !to) continue;
        const auto& places = edges_[face.sides[border].edge].places;
        const auto first = places.upper_bound(std::min(*from, *to));
        const auto last = places.lower_bound(std::max(*from, *to));
        const std::size_t start = out.size();
        for (auto it = first; it != last; ++it)
            if (live[it->second.index()])
                out.push_back({it->second, smooth_at(face, border, it->first)});
        if (*from > *to) std::reverse(out.begin() + static_cast<std::ptrdiff_t>(start), out.end());
        return;
    }
    // Inside the face: bisect as the neighbour's quadtree does.
    const auto visit = [&](const auto& self, std::array<std::int32_t, 2> p,
                           std::array<std::int32_t, 2> q) -> void {
        const std::array<std::int32_t, 2> m{(p[0] + q[0]) / 2, (p[1] + q[1]) / 2};
        if (m == p || m == q || (p[0] + q[0]) % 2 || (p[1] + q[1]) % 2) return;
        const auto position = find_position(face, m[0], m[1]);
        if (!position || !live[position->index()]) return;
        self(self, p, m);
        out.push_back({*position, face.smooth});
        self(self, m, q);
    };
    visit(visit, a, b);
}

std::size_t Mesh::bytes() const {
    std::size_t on_edges = 0;
    for (const Edge& edge : edges_) on_edges += edge.places.size();
    return positions_.capacity() * sizeof(Vec3) + faces_.capacity() * sizeof(Face) +
           patches_.capacity() * sizeof(Patch) + elements_.capacity() * sizeof(Element) +
           vertices_.capacity() * sizeof(Vertex) +
           (inside_.bucket_count() + vertex_at_.bucket_count()) * 32 +
           leaves_at_.bucket_count() * 40 + on_edges * 48 + edges_.capacity() * sizeof(Edge);
}

}  // namespace exitance
