// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/lamps.h"

#include <algorithm>

#include "exitance/math/box.h"
#include "exitance/math/polygon.h"
#include "exitance/run/random.h"
#include "exitance/solve/light_source.h"

namespace exitance {

namespace {

constexpr std::uint64_t luminaire_numbers = 0x1abULL;  // apart from those of elements and faces

std::size_t group_of(std::span<const float> row, const Columns& columns) {
    for (std::size_t c = 0; c < columns.count; ++c)
        if (row[c] != 0) return c / columns.bands;
    return 0;
}

class Planter {
  public:
    Planter(std::vector<Lamps::Placed>& lamps, std::vector<Lamps::Branch>& branches)
        : lamps_(lamps), branches_(branches) {}

    void plant(std::size_t begin, std::size_t end) {
        const std::size_t at = branches_.size();
        branches_.push_back({static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)});
        if (end - begin == 1) return;
        Box box;
        for (std::size_t i = begin; i < end; ++i) box.add(lamps_[i].place);
        const Vec3 size = box.size();
        const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0
                                 : size.y >= size.z                   ? 1
                                                                      : 2;
        const auto first = lamps_.begin() + static_cast<std::ptrdiff_t>(begin);
        const std::size_t half = (end - begin) / 2;
        std::nth_element(first, first + static_cast<std::ptrdiff_t>(half),
                         lamps_.begin() + static_cast<std::ptrdiff_t>(end),
                         [&](const Lamps::Placed& a, const Lamps::Placed& b) {
                             const double x = a.place[axis], y = b.place[axis];
                             return x != y ? x < y : a.lamp.number < b.lamp.number;
                         });
        plant(begin, begin + half);
        branches_[at].right = static_cast<std::uint32_t>(branches_.size());
        plant(begin + half, end);
    }

  private:
    std::vector<Lamps::Placed>& lamps_;
    std::vector<Lamps::Branch>& branches_;
};

}  // namespace

std::vector<FaceId> emitters_of(const Radiosity& radiosity) {
    const Mesh& mesh = radiosity.mesh;
    std::vector<FaceId> emitters;
    std::vector<double> flux(mesh.faces().size(), 0.0);
    for (std::size_t f = 0; f < mesh.faces().size(); ++f) {
        const Face& face = mesh.faces()[f];
        if (!radiosity.emits(face)) continue;
        const auto corners = mesh.corners(face);
        flux[f] = area({corners.data(), face.count}) *
                  static_cast<double>(radiosity.columns.luminance(radiosity.emitted(face)));
        emitters.push_back(FaceId(f));
    }
    std::stable_sort(emitters.begin(), emitters.end(),
                     [&](FaceId a, FaceId b) { return flux[a.index()] > flux[b.index()]; });
    return emitters;
}

namespace {

std::vector<Lamps::Placed> placed_lamps(const Radiosity& radiosity, std::span<const FaceId> faces) {
    std::vector<Lamps::Placed> placed;
    const auto place = [&](Lamp lamp, const Vec3& at) {
        lamp.level = radiosity.columns.luminance(lamp.emitted);
        if (lamp.level > 0) placed.push_back({lamp, at, group_of(lamp.emitted, radiosity.columns)});
    };
    for (const FaceId f : faces) {
        const Face& face = radiosity.mesh[f];
        const auto corners = radiosity.mesh.corners(face);
        Vec3 middle;
        for (std::size_t i = 0; i < face.count; ++i) middle = middle + corners[i] / face.count;
        place({.face = f,
               .polygon = radiosity.source(face, corners),
               .emitted = radiosity.emitted(face),
               .number = number_of_face(f)},
              middle);
    }
    for (std::size_t l = 0; l < radiosity.luminaires.size(); ++l)
        place({.luminaire = &radiosity.luminaires[l],
               .emitted = radiosity.emitted_by_luminaire(l),
               .number = static_cast<std::uint32_t>(hash_bits(luminaire_numbers, l))},
              radiosity.luminaires[l].luminaire().position);
    return placed;
}

}  // namespace

Lamps::Lamps(const Radiosity& radiosity, std::span<const FaceId> faces)
    : Lamps(placed_lamps(radiosity, faces)) {}

Lamps::Lamps(std::vector<Placed> placed) {
    std::stable_sort(placed.begin(), placed.end(),
                     [](const Placed& a, const Placed& b) { return a.group < b.group; });
    Planter planter(placed, branches_);
    for (std::size_t begin = 0, end = 0; begin < placed.size(); begin = end) {
        while (end < placed.size() && placed[end].group == placed[begin].group) ++end;
        roots_.push_back(static_cast<std::uint32_t>(branches_.size()));
        planter.plant(begin, end);
    }
    for (const Placed& lamp : placed) lamps_.push_back(lamp.lamp);
}

std::size_t Lamps::bytes() const {
    return lamps_.capacity() * sizeof(Lamp) + branches_.capacity() * sizeof(Branch);
}

}  // namespace exitance
