// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/light_source.h"

#include <algorithm>
#include <cmath>

namespace exitance {

namespace {

// Polygons' own numbers follow those of elements.
constexpr std::uint32_t first_face_number = 0x80000000u;

class Collector {
  public:
    Collector(const Radiosity& radiosity, LightSource& out, std::span<const float> ambient)
        : radiosity_(radiosity), out_(out), ambient_(ambient) {}

    // Fills node `at`; exitances go up as area-weighted means.
    void visit(std::size_t at, ElementId id) {
        const std::size_t stride = radiosity_.columns.stride;
        const Element& element = radiosity_.mesh[id];
        if (element.leaf()) {
            std::vector<float> row(stride);
            radiosity_.reflected_exitance(id, row);
            const auto rho = radiosity_.rho(radiosity_.mesh.face_of(element));
            for (std::size_t c = 0; c < stride; ++c)
                out_.exitance[at * stride + c] =
                    row[c] - radiosity_.shot[id][c] + rho[c] * ambient_[c];
        } else {
            const std::size_t first = out_.nodes.size();
            for (std::size_t c = 0; c < 4; ++c)
                append(ElementId(element.first_child.index() + c));
            for (std::size_t c = 0; c < 4; ++c)
                visit(first + c, ElementId(element.first_child.index() + c));
            float total = 0;
            for (std::size_t k = 0; k < 4; ++k) {
                const float area = out_.nodes[first + k].source.area;
                total += area;
                for (std::size_t c = 0; c < stride; ++c)
                    out_.exitance[at * stride + c] +=
                        area * out_.exitance[(first + k) * stride + c];
            }
            for (std::size_t c = 0; c < stride; ++c) out_.exitance[at * stride + c] /= total;
            out_.nodes[at].first_child = static_cast<std::uint32_t>(first);
        }
        LightSource::Node& node = out_.nodes[at];
        node.luminance = radiosity_.columns.luminance(out_.row(at, stride));
        if (node.first_child != 0)
            for (std::size_t k = 0; k < 4; ++k) {
                const LightSource::Node& child = out_.nodes[node.first_child + k];
                node.spread = std::max(
                    node.spread, std::abs(child.luminance - node.luminance) + child.spread);
            }
    }

    void append(ElementId id) {
        const Element& element = radiosity_.mesh[id];
        out_.nodes.push_back({Source(radiosity_.mesh.corners(element), element.count,
                                     radiosity_.caster.middle()),
                              id.value, 0, 0.0f, 0.0f});
        out_.exitance.resize(out_.nodes.size() * radiosity_.columns.stride, 0.0f);
    }

  private:
    const Radiosity& radiosity_;
    LightSource& out_;
    std::span<const float> ambient_;
};

}  // namespace

LightSource emission_of(const Radiosity& radiosity, FaceId id) {
    const Face& face = radiosity.mesh[id];
    const auto E = radiosity.emitted(face);
    LightSource out;
    out.nodes.push_back({Source(radiosity.mesh.corners(face), face.count,
                                radiosity.caster.middle()),
                         first_face_number | id.value, 0, radiosity.columns.luminance(E), 0.0f});
    out.exitance.assign(E.begin(), E.end());
    return out;
}

LightSource unshot_of(const Radiosity& radiosity, PatchId patch, std::span<const float> ambient) {
    LightSource out;
    Collector collector(radiosity, out, ambient);
    collector.append(radiosity.mesh[patch].root);
    collector.visit(0, radiosity.mesh[patch].root);
    return out;
}

}  // namespace exitance
