// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/write_scene.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>

#include "exitance/run/error.h"
#include "exitance/scene/formats/source_text.h"
#include "exitance/scene/merge.h"

namespace exitance {

namespace {

using Writer = std::vector<std::string> (*)(const Scene&, const std::filesystem::path&);

const std::map<std::string, Writer>& writers() {
    static const std::map<std::string, Writer> table{{".glb", write_gltf}, {".gltf", write_gltf},
                                                     {".obj", write_obj},  {".geom", write_afit},
                                                     {".mgf", write_mgf},  {".rad", write_rad}};
    return table;
}

// What is up in files of a format; none where it has no convention.
std::optional<Vec3> up_of(const std::string& ending) {
    if (ending == ".glb" || ending == ".gltf") return Vec3{0, 1, 0};
    if (ending == ".mgf" || ending == ".rad") return Vec3{0, 0, 1};
    return std::nullopt;
}

// The shortest rotation that brings unit vector `from` to `to` (Rodrigues); exact for axes.
Transform turn(const Vec3& from, const Vec3& to) {
    const double c = dot(from, to);
    Vec3 axis = cross(from, to);
    const double s = length(axis);
    if (s == 0) axis = cross(from, std::abs(from.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
    axis = normalized(axis);
    const auto turned = [&](const Vec3& v) {
        return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
    };
    return {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1}), {}};
}

Scene upright(const Scene& scene, const Vec3& up) {
    Scene out;
    out.title = scene.title;
    out.quantity = scene.quantity;
    out.bands = scene.bands;
    out.up = up;
    merge(out, scene, turn(scene.up, up));
    return out;
}

}  // namespace

std::vector<std::string> writable_endings() {
    std::vector<std::string> out;
    for (const auto& [ending, writer] : writers()) out.push_back(ending);
    return out;
}

std::vector<std::string> write_scene(const Scene& scene, const std::filesystem::path& path) {
    const auto found = writers().find(lower_extension(path));
    if (found == writers().end())
        throw Error(Fault::wrong_use,
                    fmt::format("no scene can be written as '{}'", path.string()));
    const auto up = up_of(found->first);
    if (up && *up != scene.up) return found->second(upright(scene, *up), path);
    return found->second(scene, path);
}

}  // namespace exitance
