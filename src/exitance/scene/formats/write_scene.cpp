// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/write_scene.h"

#include <fmt/format.h>

#include <map>

#include "exitance/run/error.h"

namespace exitance {

namespace {

using Writer = std::vector<std::string> (*)(const Scene&, const std::filesystem::path&);

const std::map<std::string, Writer>& writers() {
    static const std::map<std::string, Writer> table{{".glb", write_gltf}, {".gltf", write_gltf},
                                                     {".obj", write_obj},  {".geom", write_afit},
                                                     {".mgf", write_mgf},  {".rad", write_rad}};
    return table;
}

}  // namespace

std::vector<std::string> writable_endings() {
    std::vector<std::string> out;
    for (const auto& [ending, writer] : writers()) out.push_back(ending);
    return out;
}

std::vector<std::string> write_scene(const Scene& scene, const std::filesystem::path& path) {
    const auto found = writers().find(path.extension().string());
    if (found == writers().end())
        throw Error(Fault::wrong_use,
                    fmt::format("no scene can be written as '{}'", path.string()));
    return found->second(scene, path);
}

}  // namespace exitance
