// SPDX-License-Identifier: Apache-2.0
// From polygons to faces and patches: weld, cut along contacts, take sides, join what is smooth,
// divide.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "exitance/math/disjoint_sets.h"
#include "exitance/math/polygon.h"
#include "exitance/mesh/cut.h"
#include "exitance/mesh/mesh.h"
#include "exitance/mesh/weld.h"

namespace exitance {

namespace {

// Coplanar: normals within a quarter of a degree.
constexpr double coplanar_cosine = 0.99999;
// Shading normals that a file gives to both sides of an edge are the same within a degree.
constexpr double smooth_cosine = 0.9998;
// Shading normals round a face if they are within 50 degrees of its own; means over the corner of a
// box are 54 off.
constexpr double rounding_cosine = 0.64;
// A polygon within this many welding distances of another stands on it.
constexpr double contact_gap = 100;

std::uint64_t bits_of(std::uint32_t high, std::uint32_t low) {
    return std::uint64_t{high} << 32 | low;
}

// Two factors of `patches` whose ratio is nearest to width : height.
std::array<std::uint32_t, 2> divide_exactly(std::uint32_t patches, double width, double height) {
    std::array<std::uint32_t, 2> best{patches, 1};
    double best_misfit = INFINITY;
    for (std::uint32_t columns = 1; columns <= patches; ++columns) {
        if (patches % columns) continue;
        const std::uint32_t rows = patches / columns;
        const double misfit = std::abs(std::log((width / columns) / (height / rows)));
        if (misfit < best_misfit) best_misfit = misfit, best = {columns, rows};
    }
    return best;
}

std::uint32_t divide_by_size(double length, double size) {
    return static_cast<std::uint32_t>(std::clamp(std::ceil(length / size - 1e-6), 1.0, 4096.0));
}

// Shading normal of a flat polygon at one of its points, from those of its corners.
Vec3 shading_normal(std::span<const Vec3> corners, std::span<const Vec3> normals, const Vec3& p) {
    Vec3 best;
    double least = INFINITY;
    for (std::size_t i = 2; i < corners.size(); ++i) {
        const Vec3 n = vector_area(std::array{corners[0], corners[i - 1], corners[i]});
        const double whole = dot(n, n);
        if (whole <= 0) continue;
        const double b = dot(n, vector_area(std::array{corners[0], p, corners[i]})) / whole;
        const double c = dot(n, vector_area(std::array{corners[0], corners[i - 1], p})) / whole;
        const double outside = -std::min({b, c, 1 - b - c});
        if (outside >= least) continue;
        least = outside;
        best = normals[0] * (1 - b - c) + normals[i - 1] * b + normals[i] * c;
    }
    return normalized(best);
}

}  // namespace

class MeshBuilder {
  public:
    MeshBuilder(Mesh& mesh, const Scene& scene, const MeshOptions& options)
        : mesh_(mesh), scene_(scene), options_(options), welder_(scene.bounds(), mesh.positions_) {}

    void run() {
        weld();
        make_faces();
        join_smooth();
        make_patches();
    }

  private:
    using Key = Mesh::Key;
    using Edge = Mesh::Edge;
    static constexpr std::int64_t edge_steps = Mesh::edge_steps;

    void weld() {
        std::vector<char> used(scene_.points.size(), 0);
        for (const Polygon& polygon : scene_.polygons)
            for (const std::uint32_t i : polygon.indices()) used[i] = 1;
        position_of_point_.resize(scene_.points.size());
        for (std::size_t i = 0; i < scene_.points.size(); ++i)
            if (used[i]) position_of_point_[i] = welder_.at(scene_.points[i]);
    }

    void make_faces() {
        const double gap = contact_gap * welder_.tolerance();
        const auto contacts = find_contacts(scene_, options_.shortest_contact, gap);
        for (std::size_t p = 0; p < scene_.polygons.size(); ++p) {
            const Polygon& polygon = scene_.polygons[p];
            const std::uint32_t n = polygon.size();
            Face whole;
            whole.polygon = PolygonId(p);
            whole.surface = polygon.surface;
            whole.count = n;
            std::array<Vec3, 4> at;
            for (std::uint32_t i = 0; i < n; ++i) {
                whole.corners[i] = position_of_point_[polygon.corners[i]];
                at[i] = mesh_[whole.corners[i]];
                whole.normals[i] = scene_.normals[polygon.corners[i]];
            }
            const std::span corners(at.data(), n);
            // Degenerate after welding: it has no light of its own (still blocks rays, harmlessly).
            bool degenerate = area(corners) <= 0;
            for (std::uint32_t i = 0; i < n; ++i)
                degenerate |= whole.corners[i] == whole.corners[(i + 1) % n];
            if (degenerate) continue;
            whole.normal = unit_normal(corners);
            if (contacts[p].empty() || !is_strictly_convex(corners)) {
                for (std::uint32_t i = 0; i < n; ++i)
                    whole.sides[i] = side(whole.corners[i], whole.corners[(i + 1) % n]);
                add(whole, polygon.patches);
            } else {
                add_pieces(whole, corners, cut(corners, contacts[p], gap), polygon.patches);
            }
        }
    }

    void add_pieces(const Face& whole, std::span<const Vec3> corners, const CutPolygon& parts,
                    std::uint32_t patches) {
        std::vector<PositionId> place(whole.corners.begin(), whole.corners.begin() + whole.count);
        for (std::size_t i = place.size(); i < parts.places.size(); ++i)
            place.push_back(welder_.at(parts.places[i]));
        std::vector<std::uint32_t> edge;
        std::vector<char> forward;
        for (const CutLine& line : parts.lines) {
            const PositionId from = place[line.from], to = place[line.to];
            edge.push_back(edge_between(from, to));
            forward.push_back(from < to);
            Edge& e = mesh_.edges_[edge.back()];
            for (const CutLine::Mark& m : line.marks)
                e.places.emplace(step(m.at, from < to), place[m.place]);
            for (const CutLine::Contacted& c : line.contacts) {
                // Where light gets round an end, the end itself has one light.
                std::array<std::int64_t, 2> range{step(c.begin, true) + c.open_begin,
                                                  step(c.end, true) - c.open_end};
                if (!(from < to)) range = {edge_steps - range[1], edge_steps - range[0]};
                e.contacts.push_back({range[0], range[1], PolygonId(c.polygon)});
            }
        }
        const double whole_area = area(corners);
        const std::span normals(whole.normals.data(), whole.count);
        for (const Piece& part : parts.pieces) {
            Face face = whole;
            face.count = part.count;
            std::array<Vec3, 4> at;
            for (std::uint32_t i = 0; i < part.count; ++i) {
                face.corners[i] = place[part.corners[i]];
                at[i] = mesh_[face.corners[i]];
                const Piece::Side& s = part.sides[i];
                face.sides[i] = {edge[s.line], step(s.begin, forward[s.line]),
                                 step(s.end, forward[s.line]), 0};
                face.normals[i] = shading_normal(corners, normals, parts.places[part.corners[i]]);
            }
            const double share = area({at.data(), part.count}) / whole_area;
            if (share <= 0) continue;
            add(face, patches > 0
                          ? std::max(1u, static_cast<std::uint32_t>(std::lround(patches * share)))
                          : 0u);
        }
    }

    static std::int64_t step(double t, bool forward) {
        const std::int64_t s = std::llround(t * static_cast<double>(edge_steps));
        return forward ? s : edge_steps - s;
    }

    std::uint32_t edge_between(PositionId a, PositionId b) {
        const auto [slot, fresh] =
            edge_of_.insert({Key{bits_of(std::min(a, b).value, std::max(a, b).value), 0},
                             static_cast<std::uint32_t>(mesh_.edges_.size())});
        if (fresh) mesh_.edges_.push_back({{std::min(a, b), std::max(a, b)}, {}, {}});
        return slot->second;
    }

    Face::Side side(PositionId a, PositionId b) {
        const bool forward = a < b;
        return {edge_between(a, b), step(0, forward), step(1, forward), 0};
    }

    // Divides a face into patches, and adds it and its reverse side.
    void add(Face face, std::uint32_t patches) {
        const std::uint32_t n = face.count;
        const auto at = mesh_.corners(face);
        const double width = std::max(length(at[1] - at[0]), n == 4 ? length(at[2] - at[3]) : 0.0);
        const double height = n == 4 ? std::max(length(at[2] - at[1]), length(at[3] - at[0]))
                                     : std::max(length(at[2] - at[1]), length(at[2] - at[0]));
        const bool as_file = options_.divide_as_file && patches > 0;
        if (n == 3) {
            face.columns = as_file ? static_cast<std::uint32_t>(
                                         std::ceil(std::sqrt(static_cast<double>(patches)) - 1e-9))
                                   : divide_by_size(std::max(width, height), options_.patch_size);
            face.rows = face.columns;
        } else if (as_file) {
            const auto [columns, rows] = divide_exactly(patches, width, height);
            face.columns = columns, face.rows = rows;
        } else {
            face.columns = divide_by_size(width, options_.patch_size);
            face.rows = divide_by_size(height, options_.patch_size);
        }
        face.piece = pieces_++;
        for (const bool back : {false, true}) {
            if (back && !scene_.material(scene_.polygons[face.polygon.index()]).two_sided) break;
            if (back) turn(face);
            // Normals far from the face's do not round it: they are means over the corner of a box,
            // or nonsense. Light would be received from where the face cannot see.
            for (std::uint32_t i = 0; i < n; ++i)
                if (dot(face.normals[i], face.normal) < rounding_cosine) face.normals[i] = {};
            mesh_.faces_.push_back(face);
        }
    }

    // Seen from behind: corners in reverse, starting so that sides keep their direction.
    static void turn(Face& face) {
        const std::uint32_t n = face.count;
        std::reverse(face.corners.begin(), face.corners.begin() + n);
        std::reverse(face.normals.begin(), face.normals.begin() + n);
        for (Vec3& m : face.normals) m = -m;
        const auto sides = face.sides;
        for (std::uint32_t i = 0; i < n; ++i) {
            face.sides[i] = sides[(2 * n - 2 - i) % n];
            std::swap(face.sides[i].begin, face.sides[i].end);
        }
        face.normal = -face.normal;
        face.back = true;
    }

    // Faces of one surface that meet along an edge share vertices if they are coplanar, or if the
    // file gives them the same shading normals there.
    void join_smooth() {
        std::vector<std::vector<std::uint32_t>> around(mesh_.edges_.size());
        for (std::size_t f = 0; f < mesh_.faces_.size(); ++f)
            for (std::uint32_t i = 0; i < mesh_.faces_[f].count; ++i)
                around[mesh_.faces_[f].sides[i].edge].push_back(static_cast<std::uint32_t>(f));

        const auto normal_at = [&](const Face& face, PositionId corner) {
            for (std::uint32_t i = 0; i < face.count; ++i)
                if (face.corners[i] == corner)
                    return face.normals[i] == Vec3{} ? face.normal : face.normals[i];
            return face.normal;
        };
        DisjointSets sets(mesh_.faces_.size());
        for (std::size_t e = 0; e < mesh_.edges_.size(); ++e) {
            for (const std::uint32_t f : around[e]) {
                for (const std::uint32_t g : around[e]) {
                    if (g <= f) continue;
                    const Face &a = mesh_.faces_[f], &b = mesh_.faces_[g];
                    if (scene_.surfaces[a.surface].material !=
                            scene_.surfaces[b.surface].material ||
                        a.surface != b.surface)
                        continue;
                    bool smooth = dot(a.normal, b.normal) > 0.5;
                    for (const PositionId end : mesh_.edges_[e].ends) {
                        const double cosine = dot(normal_at(a, end), normal_at(b, end));
                        smooth = smooth && cosine > smooth_cosine;
                    }
                    if (smooth || dot(a.normal, b.normal) > coplanar_cosine) sets.join(f, g);
                }
            }
        }
        for (std::size_t f = 0; f < mesh_.faces_.size(); ++f) {
            Face& face = mesh_.faces_[f];
            face.smooth = sets.find(static_cast<std::uint32_t>(f));
            for (Face::Side& side : face.sides) side.smooth = face.smooth;
            face.corner_smooth.fill(face.smooth);
        }
        part_at_contacts(around);
    }

    // Where something stands on an edge, faces that would be smooth across it are not.
    void part_at_contacts(const std::vector<std::vector<std::uint32_t>>& around) {
        std::vector<std::uint32_t> smooth_of_polygon(scene_.polygons.size(), UINT32_MAX);
        for (const Face& face : mesh_.faces_)
            smooth_of_polygon[face.polygon.index()] =
                std::min(smooth_of_polygon[face.polygon.index()], face.smooth);
        auto next = static_cast<std::uint32_t>(mesh_.faces_.size());
        for (std::size_t e = 0; e < mesh_.edges_.size(); ++e) {
            auto& contacts = mesh_.edges_[e].contacts;
            if (contacts.empty()) continue;
            // Per smooth surface: whether its faces run along the edge one way and the other, and
            // then the numbers that these sides are given.
            Mesh::Table<std::array<std::uint32_t, 2>> parted;
            for_sides(around[e], e, [&](const Face& face, const Face::Side& side) {
                parted[Key{face.smooth, 0}][side.begin < side.end] = 1;
            });
            const auto crosses = [&](std::uint32_t smooth) {
                const auto found = parted.find(Key{smooth, 0});
                return found != parted.end() && found->second[0] && found->second[1];
            };
            // What goes on smoothly across the edge does not stand on it.
            std::erase_if(contacts, [&](const Edge::Contact& contact) {
                return crosses(smooth_of_polygon[contact.polygon.index()]);
            });
            if (contacts.empty()) continue;
            for_sides(around[e], e, [&](const Face& face, Face::Side& side) {
                if (!crosses(face.smooth)) return;
                std::uint32_t& number = parted[Key{face.smooth, 0}][side.begin < side.end];
                if (number == 1) number = next++;
                side.smooth = number;
            });
        }
        part_corners(next);
    }

    // Faces may meet at the end of a contact with others between them: each has a vertex of its
    // own.
    void part_corners(std::uint32_t next) {
        for (Face& face : mesh_.faces_)
            for (std::uint32_t i = 0; i < face.count; ++i) {
                const Face::Side &before = face.sides[(i + face.count - 1) % face.count],
                                 &after = face.sides[i];
                const auto touches = [&](const Face::Side& side, std::int64_t step) {
                    if (side.smooth == face.smooth) return false;
                    for (const Edge::Contact& contact : mesh_.edges_[side.edge].contacts)
                        if (contact.first <= step && step <= contact.last) return true;
                    return false;
                };
                if (touches(before, before.end) || touches(after, after.begin))
                    face.corner_smooth[i] = next++;
            }
    }

    template <class Visit>
    void for_sides(const std::vector<std::uint32_t>& faces, std::size_t edge, const Visit& visit) {
        for (const std::uint32_t f : faces)
            for (Face::Side& side : mesh_.faces_[f].sides)
                if (side.edge == edge) visit(mesh_.faces_[f], side);
    }

    void make_patches() {
        constexpr std::int32_t step = 1 << Mesh::max_level;
        for (std::size_t f = 0; f < mesh_.faces_.size(); ++f) {
            Face& face = mesh_.faces_[f];
            face.first_patch = PatchId(mesh_.patches_.size());
            const auto add = [&](std::int32_t u, std::int32_t v, std::int32_t size) {
                Element element;
                element.patch = PatchId(mesh_.patches_.size());
                element.u = u, element.v = v, element.size = size;
                element.count = static_cast<std::uint8_t>(face.count);
                const ElementId id(mesh_.elements_.size());
                mesh_.elements_.push_back(element);
                mesh_.patches_.push_back({FaceId(f), id, 0.0});
                mesh_.make_corners(id);
                mesh_.patches_.back().area = static_cast<double>(mesh_.elements_.back().area);
            };
            for (std::uint32_t j = 0; j < face.rows; ++j) {
                const auto v = static_cast<std::int32_t>(j) * step;
                if (face.count == 4) {
                    for (std::uint32_t i = 0; i < face.columns; ++i)
                        add(static_cast<std::int32_t>(i) * step, v, step);
                } else {
                    for (std::uint32_t i = 0; i + j < face.columns; ++i) {
                        const auto u = static_cast<std::int32_t>(i) * step;
                        add(u, v, step);
                        if (i + j + 1 < face.columns) add(u + step, v + step, -step);
                    }
                }
            }
        }
    }

    Mesh& mesh_;
    const Scene& scene_;
    const MeshOptions& options_;
    Welder welder_;
    std::vector<PositionId> position_of_point_;  ///< per scene point
    Mesh::Table<std::uint32_t> edge_of_;
    std::uint32_t pieces_ = 0;
};

Mesh::Mesh(const Scene& scene, const MeshOptions& options) {
    MeshBuilder(*this, scene, options).run();
}

}  // namespace exitance
