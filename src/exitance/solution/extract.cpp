// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/extract.h"

#include <tsl/robin_map.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "exitance/math/polygon.h"
#include "exitance/run/random.h"
#include "exitance/scene/texture_map.h"
#include "exitance/solution/corner_light.h"

namespace exitance {

namespace {

struct KeyHash {
    std::size_t operator()(std::uint64_t key) const { return hash_bits(key); }
};

class Extraction {
  public:
    Extraction(const Radiosity& radiosity, std::span<const float> unshot, Solution& out)
        : radiosity_(radiosity),
          mesh_(radiosity.mesh),
          out_(out),
          leaves_(leaves_of(mesh_)),
          light_(radiosity, unshot, leaves_),
          stride_(light_.stride()) {
        find_live();
    }

    void run(std::vector<PatchId>* patches) {
        std::vector<std::vector<std::array<std::uint32_t, 3>>> by_surface(
            radiosity_.scene.surfaces.size());
        std::vector<std::vector<PatchId>> patches_of(by_surface.size());
        for (const ElementId leaf : leaves_) {
            if (below_lamp(mesh_[leaf])) continue;
            const Face& face = mesh_.face_of(mesh_[leaf]);
            enter(face);
            triangulate(leaf, by_surface[face.surface]);
            patches_of[face.surface].resize(by_surface[face.surface].size(), mesh_[leaf].patch);
        }
        for (std::size_t s = 0; s < by_surface.size(); ++s) {
            if (by_surface[s].empty()) continue;
            const Surface& surface = radiosity_.scene.surfaces[s];
            out_.parts.push_back({surface.name, surface.material,
                                  radiosity_.groups.group_of_surface[s],
                                  static_cast<std::uint32_t>(out_.triangles.size()),
                                  static_cast<std::uint32_t>(by_surface[s].size())});
            part_of_surface_.resize(s + 1);
            part_of_surface_[s] = static_cast<std::uint32_t>(out_.parts.size() - 1);
            out_.triangles.insert(out_.triangles.end(), by_surface[s].begin(), by_surface[s].end());
            if (patches)
                patches->insert(patches->end(), patches_of[s].begin(), patches_of[s].end());
        }
        out_.irradiance = VertexField(out_.positions.size(), radiosity_.columns.count);
        const std::size_t columns = radiosity_.columns.stride;
        for (std::size_t v = 0; v < out_.positions.size(); ++v) {
            std::copy_n(&rows_[v * stride_], columns, out_.irradiance[VertexId(v)].begin());
            if (stride_ > columns) out_.unshot.push_back(rows_[v * stride_ + columns]);
        }
        for (const Face& face : mesh_.faces())
            if (radiosity_.emits(face))
                out_.emitters.push_back({mesh_.corners(face), face.count,
                                         part_of_surface_[face.surface], varying_emission(face)});
    }

  private:
    // Whether a lamp has all of the leaf's place: there is nothing to be seen of it.
    bool below_lamp(const Element& leaf) const {
        const Face& face = mesh_.face_of(leaf);
        const auto is_below = [&](const Vec3& place) {
            return radiosity_.owners.below_lamp(face.polygon, face.back,
                                                place - radiosity_.caster.middle());
        };
        const auto corners = mesh_.corners(leaf);
        const Vec3 middle = centroid({corners.data(), leaf.count});
        if (!is_below(middle)) return false;
        // Just inside, for corners lie on the lamp's outline.
        return std::all_of(corners.begin(), corners.begin() + leaf.count, [&](const Vec3& corner) {
            return is_below(corner * 0.99 + middle * 0.01);
        });
    }

    // Vertices made from now on are of this face: of a patterned one they have a place on its
    // textures, and are shared only with those that have the same.
    void enter(const Face& face) {
        const Scene& scene = radiosity_.scene;
        maps_.reset();
        const Material& material = scene.materials[scene.surfaces[face.surface].material];
        if (!material.patterned()) return;
        const Polygon& polygon = scene.polygons[face.polygon.index()];
        maps_ = Maps{reflectance_map(scene, polygon), exitance_map(scene, polygon)};
    }

    Spectrum varying_emission(const Face& face) const {
        const Scene& scene = radiosity_.scene;
        if (!scene.materials[scene.surfaces[face.surface].material].exitance_pattern) return {};
        return mean_exitance(scene, scene.polygons[face.polygon.index()]);
    }

    static std::vector<ElementId> leaves_of(const Mesh& mesh) {
        std::vector<ElementId> leaves;
        for (const Patch& patch : mesh.patches())
            mesh.for_leaves(patch.root, [&](ElementId id) { leaves.push_back(id); });
        return leaves;
    }

    void find_live() {
        live_.assign(mesh_.positions().size(), 0);
        for (const ElementId leaf : leaves_)
            for (const VertexId v : mesh_[leaf].corners()) live_[mesh_[v].position.index()] = 1;
    }

    std::uint32_t append(const Vec3& position, const Vec3f& normal, std::span<const float> row) {
        out_.positions.push_back(Vec3f(position));
        out_.normals.push_back(normal);
        if (maps_) {
            out_.texture_coordinates.resize(out_.positions.size());
            out_.texture_coordinates.back() = {maps_->reflectance(position),
                                               maps_->exitance(position)};
        }
        rows_.insert(rows_.end(), row.begin(), row.end());
        return static_cast<std::uint32_t>(out_.positions.size() - 1);
    }

    std::uint32_t vertex(VertexId v) {
        return made_at(mesh_[v].position, mesh_[v].smooth, [&] {
            return append(mesh_[mesh_[v].position], mesh_[v].normal, light_[v]);
        });
    }

    // A corner that lies behind what stands on the leaf is one apart, with the light before that.
    std::uint32_t corner(VertexId v) {
        if (!behind_.contains(v)) return vertex(v);
        return append(mesh_[mesh_[v].position], mesh_[v].normal, before_);
    }

    std::span<const float> light_in_leaf(VertexId v) const {
        return behind_.contains(v) ? std::span<const float>(before_) : light_[v];
    }

    /// The vertex at a place of a smooth surface, and of its textures; made when first asked for.
    template <class Make>
    std::uint32_t made_at(PositionId at, std::uint32_t smooth, const Make& make) {
        const auto [slot, fresh] = index_.insert({key(at, smooth), 0u});
        if (fresh) return slot.value() = make();
        if (!maps_) return slot->second;
        // A seam of the texture: one vertex for each side.
        const TextureCoordinates wanted{maps_->reflectance(mesh_[at]), maps_->exitance(mesh_[at])};
        for (std::uint32_t v = slot->second;; v = across_seam_[v]) {
            if (close(out_.texture_coordinates[v], wanted)) return v;
            const auto next = across_seam_.find(v);
            if (next != across_seam_.end()) continue;
            const std::uint32_t made = make();
            across_seam_[v] = made;
            return made;
        }
    }

    static bool close(const TextureCoordinates& a, const TextureCoordinates& b) {
        constexpr float rounding = 1e-4f;  // of coordinates over a few repetitions
        const auto near = [](const TexturePoint& p, const TexturePoint& q) {
            return std::abs(p.u - q.u) <= rounding && std::abs(p.v - q.v) <= rounding;
        };
        return near(a.reflectance, b.reflectance) && near(a.exitance, b.exitance);
    }

    static std::uint64_t key(PositionId position, std::uint32_t smooth) {
        return std::uint64_t{position.value} << 32 | smooth;
    }

    // The outline of a leaf: its corners and every place that others put on its sides.
    void outline(const Element& element, std::vector<std::uint32_t>& loop) {
        loop.clear();
        for (std::uint32_t side = 0; side < element.count; ++side) {
            const VertexId from = element.vertices[side];
            const VertexId to = element.vertices[(side + 1) % element.count];
            loop.push_back(corner(from));
            between_.clear();
            mesh_.between(element, side, live_, between_);
            for (std::size_t k = 0; k < between_.size(); ++k) {
                if (const auto own = own_vertex(k)) {
                    loop.push_back(vertex(*own));
                    continue;
                }
                // Only other surfaces have a vertex here: interpolate between our nearest two.
                VertexId before = from, after = to;
                for (std::size_t j = k; j-- > 0 && before == from;)
                    before = own_vertex(j).value_or(from);
                for (std::size_t j = k + 1; j < between_.size() && after == to; ++j)
                    after = own_vertex(j).value_or(to);
                loop.push_back(
                    interpolated(between_[k].position, between_[k].smooth, before, after));
            }
        }
    }

    std::optional<VertexId> own_vertex(std::size_t k) const {
        return mesh_.find_vertex(between_[k].position, between_[k].smooth);
    }

    std::uint32_t interpolated(PositionId at, std::uint32_t smooth, VertexId a, VertexId b) {
        return made_at(at, smooth, [&] {
            const Vec3 from = mesh_[mesh_[a].position], to = mesh_[mesh_[b].position];
            const auto t = static_cast<float>(length(mesh_[at] - from) / length(to - from));
            std::vector<float> row(stride_);
            for (std::size_t c = 0; c < row.size(); ++c)
                row[c] = (1.0f - t) * light_in_leaf(a)[c] + t * light_in_leaf(b)[c];
            const Vec3f normal = normalized(mesh_[a].normal * (1.0f - t) + mesh_[b].normal * t);
            return append(mesh_[at], normal, row);
        });
    }

    void triangulate(ElementId leaf, std::vector<std::array<std::uint32_t, 3>>& triangles) {
        const Element& element = mesh_[leaf];
        behind_ = light_.corners_behind(element, before_);
        outline(element, loop_);
        if (loop_.size() == 3) {
            triangles.push_back({loop_[0], loop_[1], loop_[2]});
        } else if (loop_.size() == 4 && element.count == 4) {
            // The diagonal along which the light changes less.
            const auto level = [&](std::size_t i) {
                return radiosity_.columns.luminance(
                    {&rows_[loop_[i] * stride_], radiosity_.columns.stride});
            };
            if (std::abs(level(0) - level(2)) <= std::abs(level(1) - level(3))) {
                triangles.push_back({loop_[0], loop_[1], loop_[2]});
                triangles.push_back({loop_[0], loop_[2], loop_[3]});
            } else {
                triangles.push_back({loop_[0], loop_[1], loop_[3]});
                triangles.push_back({loop_[1], loop_[2], loop_[3]});
            }
        } else {
            const std::uint32_t middle = centre(element);
            for (std::size_t i = 0; i < loop_.size(); ++i)
                triangles.push_back({middle, loop_[i], loop_[(i + 1) % loop_.size()]});
        }
    }

    std::uint32_t centre(const Element& element) {
        const float share = 1.0f / static_cast<float>(element.count);
        Vec3 position;
        Vec3f normal;
        std::vector<float> row(stride_, 0.0f);
        for (const VertexId v : element.corners()) {
            position += mesh_[mesh_[v].position] * static_cast<double>(share);
            normal += mesh_[v].normal;
            for (std::size_t c = 0; c < row.size(); ++c) row[c] += share * light_in_leaf(v)[c];
        }
        return append(position, normalized(normal), row);
    }

    const Radiosity& radiosity_;
    const Mesh& mesh_;
    Solution& out_;
    std::vector<ElementId> leaves_;
    CornerLight light_;
    std::size_t stride_;  ///< of a row: the columns of light and maybe what is unshot
    std::vector<char> live_;
    CornerLight::Corners behind_;  ///< of the leaf that is being made into triangles
    std::vector<float> before_;    ///< their light
    std::vector<float> rows_;      ///< irradiance of the vertices made so far
    tsl::robin_map<std::uint64_t, std::uint32_t, KeyHash> index_;
    struct Maps {
        TextureMap reflectance, exitance;
    };
    std::optional<Maps> maps_;  ///< of the face whose leaves are being made into triangles
    std::unordered_map<std::uint32_t, std::uint32_t> across_seam_;  ///< vertex → the next there
    std::vector<Mesh::Between> between_;
    std::vector<std::uint32_t> loop_;
    std::vector<std::uint32_t> part_of_surface_;
};

}  // namespace

Solution extract_solution(const Radiosity& radiosity, std::span<const float> unshot,
                          std::vector<PatchId>* patches) {
    const Scene& scene = radiosity.scene;
    Solution out;
    out.title = scene.title;
    out.quantity = scene.quantity;
    out.bands = scene.bands;
    out.up = scene.up;
    out.groups = radiosity.groups.groups;
    out.materials = scene.materials;
    for (std::size_t l = 0; l < scene.luminaires.size(); ++l)
        out.luminaires.push_back({scene.luminaires[l], radiosity.groups.group_of_luminaire[l]});
    for (std::size_t l = 0; l < scene.distant.size(); ++l)
        out.distant.push_back({scene.distant[l], radiosity.groups.group_of_distant[l]});
    out.light_scenes = scene.light_scenes;
    out.cameras = scene.cameras;
    out.grids = scene.grids;
    out.scene_digest = digest(scene);
    Extraction(radiosity, unshot, out).run(patches);
    if (!out.texture_coordinates.empty()) out.texture_coordinates.resize(out.positions.size());
    return out;
}

}  // namespace exitance
