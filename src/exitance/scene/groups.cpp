// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/groups.h"

#include <algorithm>

namespace exitance {

namespace {

std::string group_name(const Scene& scene, const Surface& surface, Grouping grouping) {
    const Material& material = scene.materials[surface.material];
    switch (grouping) {
        case Grouping::none:
            return "all";
        case Grouping::luminaire:
            return surface.name.empty() ? material.name : surface.name;
        case Grouping::material:
            return material.name;
        case Grouping::file:
            return material.group.empty() ? "light" : material.group;
    }
    return "all";
}

// Luminaires, sun and sky.
template <class Light>
std::string name_of_light(const Light& luminaire, Grouping grouping) {
    switch (grouping) {
        case Grouping::none:
            return "all";
        case Grouping::luminaire:
        case Grouping::material:
            return luminaire.name;
        case Grouping::file:
            return luminaire.group.empty() ? "light" : luminaire.group;
    }
    return "all";
}

}  // namespace

LightGroups make_groups(const Scene& scene, Grouping grouping) {
    LightGroups out;
    const auto index_of = [&](const std::string& name) {
        auto found = std::find_if(out.groups.begin(), out.groups.end(),
                                  [&](const LightGroup& g) { return g.name == name; });
        if (found == out.groups.end()) found = out.groups.insert(found, LightGroup{name, 1.0});
        return static_cast<std::uint32_t>(found - out.groups.begin());
    };
    out.group_of_surface.assign(scene.surfaces.size(), 0);
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
        if (scene.materials[scene.surfaces[s].material].emits())
            out.group_of_surface[s] = index_of(group_name(scene, scene.surfaces[s], grouping));
    for (const Luminaire& luminaire : scene.luminaires)
        out.group_of_luminaire.push_back(index_of(name_of_light(luminaire, grouping)));
    for (const DistantLight& light : scene.distant)
        out.group_of_distant.push_back(index_of(name_of_light(light, grouping)));
    if (out.groups.empty()) out.groups.push_back({"all", 1.0});
    return out;
}

}  // namespace exitance
