// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/read.h"

#include "exitance/scene/formats/afit.h"
#include "exitance/scene/formats/gltf.h"
#include "exitance/scene/formats/source_text.h"
#include "exitance/scene/mend.h"

namespace exitance {

namespace {

// A display file beside a geometry file of the same stem says who looks.
Scene read_afit_with_display(const std::filesystem::path& path, std::string_view text) {
    Scene scene = parse_afit_geometry(path.string(), text);
    std::filesystem::path display = path;
    display.replace_extension(".display");
    if (std::filesystem::exists(display))
        scene.cameras.push_back(camera_of(read_afit_display(display)));
    return scene;
}

// The extension decides; a file without a known one is judged by how it begins.
Scene read_by_kind(const std::filesystem::path& path) {
    const std::string bytes = read_whole_file(path);
    const std::string extension = path.extension().string();
    if (extension == ".glb" || extension == ".gltf") return parse_gltf(path, bytes);
    if (extension == ".geom") return read_afit_with_display(path, bytes);
    if (looks_like_afit_geometry(bytes)) return read_afit_with_display(path, bytes);
    if (looks_like_gltf(bytes)) return parse_gltf(path, bytes);
    throw Error({path.string(), 0, 0},
                "not a scene that can be read, expected .geom (AFIT), .gltf or .glb");
}

}  // namespace

Scene read_scene(const std::filesystem::path& path) {
    Scene scene = read_by_kind(path);
    mend(scene);
    return scene;
}

}  // namespace exitance
