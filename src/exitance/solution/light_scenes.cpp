// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/light_scenes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace exitance {

void apply_light_scene(Solution& solution, const std::string& name) {
    std::vector<std::string> names;
    for (const LightScene& scene : solution.light_scenes) names.push_back(scene.name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
        throw Error(Fault::wrong_use,
                    names.empty()
                        ? "--scene: the solution has no named scenes"
                        : fmt::format("--scene: there is no '{}'{}; the scenes are {}", name,
                                      suggestion(name, names), fmt::join(names, ", ")));
    const auto index = static_cast<std::size_t>(found - names.begin());
    for (const auto& [group, factor] : solution.light_scenes[index].factors) {
        const auto of_group =
            std::find_if(solution.groups.begin(), solution.groups.end(),
                         [&, wanted = group](const LightGroup& g) { return g.name == wanted; });
        if (of_group == solution.groups.end())
            throw Error(Fault::wrong_use,
                        fmt::format("--scene: '{}' dims the group '{}', which this solution does "
                                    "not keep apart (see --groups)",
                                    name, group));
        of_group->weight *= factor;
    }
}

}  // namespace exitance
