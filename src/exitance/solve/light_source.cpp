// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/light_source.h"

#include <algorithm>
#include <cmath>

#include "exitance/run/random.h"

namespace exitance {

namespace {

// Polygons' own numbers follow those of elements.
constexpr std::uint32_t first_face_number = 0x80000000u;
// A face that emits is divided this often for receivers near to it.
constexpr int emission_depth = 3;

using Quarters = std::array<std::array<Vec3, 4>, 4>;

Quarters quarters_of_quad(const std::array<Vec3, 4>& c) {
    const Vec3 a = (c[0] + c[1]) * 0.5, b = (c[1] + c[2]) * 0.5, d = (c[2] + c[3]) * 0.5,
               e = (c[3] + c[0]) * 0.5, m = (a + d) * 0.5;
    return {{{c[0], a, m, e}, {a, c[1], b, m}, {m, b, c[2], d}, {e, m, d, c[3]}}};
}

Quarters quarters_of_triangle(const std::array<Vec3, 4>& c) {
    const Vec3 a = (c[0] + c[1]) * 0.5, b = (c[1] + c[2]) * 0.5, d = (c[2] + c[0]) * 0.5;
    return {{{c[0], a, d, {}}, {a, c[1], b, {}}, {d, b, c[2], {}}, {a, b, d, {}}}};
}

/// Builds the tree of a patch from the exitance of its leaves, which `leaf(id, row)` fills in.
template <class Leaf>
class Collector {
  public:
    Collector(const Radiosity& radiosity, LightSource& out, const Leaf& leaf)
        : radiosity_(radiosity), out_(out), leaf_(leaf), difference_(radiosity.columns.stride) {}

    // Fills node `at`; exitances go up as area-weighted means.
    void visit(std::size_t at, ElementId id) {
        const std::size_t stride = radiosity_.columns.stride;
        const Element& element = radiosity_.mesh[id];
        if (element.leaf()) {
            out_.nodes[at].open_area = radiosity_.open_share(element) * element.area;
            leaf_(id, std::span(out_.exitance).subspan(at * stride, stride));
        } else {
            const std::size_t first = out_.nodes.size();
            for (std::size_t c = 0; c < 4; ++c) append(ElementId(element.first_child.index() + c));
            for (std::size_t c = 0; c < 4; ++c)
                visit(first + c, ElementId(element.first_child.index() + c));
            float open = 0;
            for (std::size_t k = 0; k < 4; ++k) {
                const float share = out_.nodes[first + k].open_area;
                open += share;
                for (std::size_t c = 0; c < stride; ++c)
                    out_.exitance[at * stride + c] +=
                        share * out_.exitance[(first + k) * stride + c];
            }
            for (std::size_t c = 0; open > 0 && c < stride; ++c)
                out_.exitance[at * stride + c] /= open;
            out_.nodes[at].open_area = open;
            out_.nodes[at].first_child = static_cast<std::uint32_t>(first);
        }
        LightSource::Node& node = out_.nodes[at];
        const auto row = out_.row(at, stride);
        node.luminance = radiosity_.columns.luminance(row);
        node.magnitude = radiosity_.columns.magnitude(row);
        if (node.first_child != 0)
            for (std::size_t k = 0; k < 4; ++k) {
                const LightSource::Node& child = out_.nodes[node.first_child + k];
                const auto child_row = out_.row(node.first_child + k, stride);
                for (std::size_t c = 0; c < stride; ++c) difference_[c] = child_row[c] - row[c];
                node.spread =
                    std::max(node.spread, radiosity_.columns.magnitude(difference_) + child.spread);
            }
    }

    void append(ElementId id) {
        const Element& element = radiosity_.mesh[id];
        out_.nodes.push_back(
            {Source(radiosity_.mesh.corners(element), element.count, radiosity_.caster.middle()),
             0.0f, id.value, 0, 0.0f, 0.0f, 0.0f});
        out_.exitance.resize(out_.nodes.size() * radiosity_.columns.stride, 0.0f);
    }

  private:
    const Radiosity& radiosity_;
    LightSource& out_;
    const Leaf& leaf_;
    std::vector<float> difference_;
};

template <class Leaf>
LightSource collect(const Radiosity& radiosity, PatchId patch, const Leaf& leaf) {
    LightSource out;
    Collector<Leaf> collector(radiosity, out, leaf);
    collector.append(radiosity.mesh[patch].root);
    collector.visit(0, radiosity.mesh[patch].root);
    return out;
}

}  // namespace

std::uint32_t number_of_face(FaceId face) {
    return first_face_number | face.value;
}

LightSource emission_of(const Radiosity& radiosity, FaceId id) {
    const Face& face = radiosity.mesh[id];
    const auto E = radiosity.emitted(face);
    LightSource out;
    const auto append = [&](const std::array<Vec3, 4>& corners, std::uint32_t number) {
        const Source source = radiosity.source(face, corners);
        const float level = radiosity.columns.luminance(E);
        out.nodes.push_back({source, source.area, number, 0, level, level, 0.0f});
        out.exitance.insert(out.exitance.end(), E.begin(), E.end());
    };
    const auto divide = [&](const auto& self, std::size_t at, const std::array<Vec3, 4>& c,
                            int depth) -> void {
        if (depth == 0) return;
        const std::size_t first = out.nodes.size();
        out.nodes[at].first_child = static_cast<std::uint32_t>(first);
        const auto quarters = face.count == 4 ? quarters_of_quad(c) : quarters_of_triangle(c);
        for (std::uint32_t k = 0; k < 4; ++k)
            append(quarters[k], static_cast<std::uint32_t>(hash_bits(out.nodes[at].number, k + 1)));
        for (std::size_t k = 0; k < 4; ++k) self(self, first + k, quarters[k], depth - 1);
    };
    const auto corners = radiosity.mesh.corners(face);
    append(corners, number_of_face(id));
    divide(divide, 0, corners, emission_depth);
    return out;
}

LightSource unshot_of(const Radiosity& radiosity, PatchId patch, std::span<const float> ambient) {
    return collect(radiosity, patch, [&](ElementId id, std::span<float> row) {
        radiosity.reflected_exitance(id, row);
        const auto rho = radiosity.rho(id), shot = radiosity.shot[id];
        for (std::size_t c = 0; c < row.size(); ++c) row[c] += rho[c] * ambient[c] - shot[c];
    });
}

LightSource shot_of(const Radiosity& radiosity, PatchId patch) {
    return collect(radiosity, patch, [&](ElementId id, std::span<float> row) {
        const auto shot = radiosity.shot[id];
        std::copy(shot.begin(), shot.end(), row.begin());
    });
}

}  // namespace exitance
