// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/divide.h"

#include "exitance/math/polygon.h"

namespace exitance {

void divide_evenly(Radiosity& radiosity, double longest_edge) {
    Mesh& mesh = radiosity.mesh;
    // Rounding must not divide what is as long as that.
    const double longest = longest_edge * (1 + 1e-9);
    std::vector<ElementId> open;
    for (const Patch& patch : mesh.patches())
        mesh.for_leaves(patch.root, [&](ElementId id) { open.push_back(id); });
    for (std::size_t next = 0; next < open.size(); ++next) {
        const ElementId id = open[next];
        if (mesh[id].leaf()) {
            const auto corners = mesh.corners(mesh[id]);
            if (longest_side({corners.data(), mesh[id].count}) <= longest) continue;
            mesh.split(id);
        }
        if (mesh[id].leaf()) continue;  // as small as elements get
        for (std::size_t c = 0; c < 4; ++c)
            open.push_back(ElementId(mesh[id].first_child.index() + c));
    }
    radiosity.admit_new_vertices();
}

}  // namespace exitance
