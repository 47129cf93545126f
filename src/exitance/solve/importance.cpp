// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/importance.h"

#include <algorithm>
#include <cmath>

#include "exitance/run/error.h"
#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
#include "exitance/transport/element_caster.h"

namespace exitance {

namespace {

// What a sensor in free space sees is averaged over its hemisphere: an error there is worth a
// quarter of one on the surface that a sensor lies on.
constexpr float worth_to_free_sensors = 0.25f;
// Errors that come by reflection are averaged over all that a point sees; what remains of them is
// the part that errs to one side.
constexpr float one_sided = 0.25f;
// Direct light that matters less than this is left as it is at the corners of patches.
constexpr float negligible = 0.01f;
constexpr std::uint32_t rays_per_patch = 64, packets_per_sensor = 4;
// Importance goes on until so much of it is left, or as many bounces.
constexpr double settled = 0.01;
constexpr int most_bounces = 16;

class Search {
  public:
    Search(const Radiosity& radiosity, std::uint64_t seed)
        : radiosity_(radiosity),
          mesh_(radiosity.mesh),
          scene_{mesh_, radiosity.caster, radiosity.owners, radiosity.two_sided()},
          rows_(roots(mesh_)),
          caster_(scene_, rows_, rays_per_patch, hash_bits(seed, 0x1a9)),
          shown_(rows_.size(), 0.0f),
          looks_(rows_.size(), 0.0f) {}

    Importance run(const Focus& focus) {
        look(focus.sight);
        read(focus);
        if (std::ranges::all_of(shown_, [](float s) { return s == 0; }))
            throw Error(Fault::wrong_use,
                        "no surface is seen from there, so there is nothing to refine the solution "
                        "for; expected a camera or a grid that looks at the scene");
        add_neighbours();
        return {shown_, weight(), echo()};
    }

  private:
    static ElementRows roots(const Mesh& mesh) {
        ElementRows rows;
        for (const Patch& patch : mesh.patches()) {
            rows.elements.push_back(patch.root);
            rows.area.push_back(static_cast<float>(patch.area));
        }
        return rows;
    }

    void show(const ElementCaster::Ends& ends, float worth) {
        for (std::uint32_t k = 0; k < ends.count; ++k)
            shown_[ends.row[k]] = std::max(shown_[ends.row[k]], worth);
    }

    void look(const std::vector<Focus::Ray>& sight) {
        ElementCaster::Ends ends;
        for (std::size_t first = 0; first < sight.size(); first += RayPacket::width) {
            RayPacket rays;
            rays.near.fill(0.0f), rays.far.fill(INFINITY);
            const std::size_t count = std::min(RayPacket::width, sight.size() - first);
            for (std::size_t k = 0; k < count; ++k)
                rays.aim(k, sight[first + k].origin - caster_.middle(), sight[first + k].direction);
            caster_.cast(rays, ends);
            show(ends, 1.0f);
            for (std::uint32_t k = 0; k < ends.count; ++k) looks_[ends.row[k]] += ends.rays[k];
        }
    }

    // A stalk before the eye is much of a picture and little of the area.
    std::vector<float> weight() const {
        double looks = 0, area = 0;
        for (std::size_t p = 0; p < shown_.size(); ++p)
            looks += double(looks_[p]), area += double(shown_[p]) * double(rows_.area[p]);
        std::vector<float> out = shown_;
        if (!(looks > 0)) return out;
        for (std::size_t p = 0; p < shown_.size(); ++p) {
            if (!(rows_.area[p] > 0)) continue;
            const double by_looks = double(looks_[p]) / looks * area / double(rows_.area[p]);
            out[p] = static_cast<float>(0.5 * (double(shown_[p]) + by_looks));
        }
        return out;
    }

    void read(const Focus& focus) {
        ElementCaster::Ends ends;
        for (std::size_t i = 0; i < focus.sensors.size(); ++i) {
            const auto& [point, normal] = focus.sensors[i];
            RayPacket down;
            down.near.fill(0.0f), down.far.fill(static_cast<float>(2 * focus.reach));
            down.aim(0, point + normal * focus.reach - caster_.middle(), -normal);
            caster_.cast(down, ends);
            show(ends, 1.0f);
            if (ends.count > 0) continue;
            for (std::uint32_t packet = 0; packet < packets_per_sensor; ++packet) {
                caster_.cast_packet(point, normal, hash_bits(0x5e, i), packet, ends);
                show(ends, worth_to_free_sensors);
            }
        }
    }

    // Rays miss slivers, and the light of a patch is interpolated from corners that its neighbours
    // share.
    void add_neighbours() {
        std::vector<float> near(mesh_.positions().size(), 0.0f);
        const auto for_corners = [&](const auto& visit) {
            for (std::size_t p = 0; p < shown_.size(); ++p)
                for (const VertexId v : mesh_[rows_.elements[p]].corners())
                    visit(shown_[p], near[mesh_[v].position.index()]);
        };
        for_corners([](float shown, float& at) { at = std::max(at, shown); });
        for_corners([](float& shown, float at) { shown = std::max(shown, at); });
    }

    // Form factors of those rows that importance has reached.
    void cast_rows(const std::vector<double>& importance) {
        hits_.resize(rows_.size());
        parallel_for(
            rows_.size(),
            [&](std::size_t i) {
                if (!(importance[i] > 0) || !hits_[i].empty()) return;
                const std::uint32_t cast = caster_.cast_row(i, [&](std::uint32_t row, float rays) {
                    hits_[i].push_back({row, rays});
                });
                for (RowHits& hit : hits_[i]) hit.rays /= static_cast<float>(cast);
            },
            64);
    }

    float reflectance(std::size_t row) const {
        const Columns& columns = radiosity_.columns;
        const auto rho = radiosity_.rho(rows_.elements[row]);
        const std::vector<float> white(columns.stride, 1.0f);
        return columns.luminance(rho) / columns.luminance(white);
    }

    // W' = W + (F ρ)ᵀ W', W what is looked at; the echo is W' − W.
    std::vector<float> echo() {
        std::vector<double> arriving(rows_.size()), all(rows_.size(), 0.0);
        double area = 0;
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            arriving[i] = double(shown_[i]) * double(rows_.area[i]);
            area += arriving[i];
        }
        for (int bounce = 0; bounce < most_bounces; ++bounce) {
            cast_rows(arriving);
            std::vector<double> next(rows_.size(), 0.0);
            for (std::size_t i = 0; i < rows_.size(); ++i)
                for (const RowHits& hit : hits_[i]) next[hit.row] += arriving[i] * double(hit.rays);
            double left = 0;
            for (std::size_t j = 0; j < rows_.size(); ++j) {
                if (next[j] > 0) next[j] *= double(reflectance(j));
                all[j] += next[j], left += next[j];
            }
            arriving = std::move(next);
            if (left < settled * area) break;
        }
        std::vector<float> out(rows_.size(), 0.0f);
        for (std::size_t j = 0; j < out.size(); ++j)
            if (rows_.area[j] > 0) out[j] = static_cast<float>(all[j] / double(rows_.area[j]));
        return out;
    }

    const Radiosity& radiosity_;
    const Mesh& mesh_;
    ElementScene scene_;
    ElementRows rows_;
    ElementCaster caster_;
    std::vector<float> shown_;
    std::vector<float> looks_;  ///< rays of cameras that end there
    std::vector<std::vector<RowHits>> hits_;
};

}  // namespace

std::vector<float> Importance::of_direct_light() const {
    std::vector<float> out(shown.size());
    for (std::size_t p = 0; p < out.size(); ++p) {
        const float worth = std::max(shown[p], std::min(1.0f, echo[p]) * one_sided);
        out[p] = worth < negligible ? 0.0f : worth;
    }
    return out;
}

Importance find_importance(const Radiosity& radiosity, const Focus& focus, std::uint64_t seed) {
    return Search(radiosity, seed).run(focus);
}

}  // namespace exitance
