// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/read.h"

#include <algorithm>

#include "exitance/scene/formats/afit.h"
#include "exitance/scene/formats/gltf.h"
#include "exitance/scene/formats/lamp_file.h"
#include "exitance/scene/formats/project.h"
#include "exitance/scene/formats/source_text.h"
#include "exitance/scene/mend.h"

namespace exitance {

namespace {

/// Files that are open one inside the other, and how many there were in all: projects that name
/// each other twice and again must come to an end.
class Nesting {
  public:
    static constexpr std::size_t deepest = 32, most = 10'000;

    /// Throws Error at `named`, where `path` is asked for, if it is one of the files it is named
    /// in.
    void enter(const std::filesystem::path& path, const Place& named) {
        std::error_code ignored;
        const auto canonical = std::filesystem::weakly_canonical(path, ignored);
        if (std::find(open_.begin(), open_.end(), canonical) != open_.end()) {
            std::string chain;
            for (const auto& file : open_) chain += file.filename().string() + " → ";
            throw Error(named, "the project includes itself: " + chain + path.filename().string());
        }
        if (open_.size() == deepest || ++count_ > most)
            throw Error(named, "projects name each other too deeply or too often to be read");
        open_.push_back(canonical);
    }
    void leave() { open_.pop_back(); }

  private:
    std::vector<std::filesystem::path> open_;
    std::size_t count_ = 0;
};

// A display file beside a geometry file of the same stem says who looks.
Scene read_afit_with_display(const std::filesystem::path& path, std::string_view text) {
    Scene scene = parse_afit_geometry(path.string(), text);
    std::filesystem::path display = path;
    display.replace_extension(".display");
    std::error_code ignored;
    if (std::filesystem::exists(display, ignored))
        scene.cameras.push_back(camera_of(read_afit_display(display)));
    return scene;
}

// The extension decides; a file without a known one is judged by how it begins.
Scene read_by_kind(const std::filesystem::path& path, const Place& named, Nesting& nesting) {
    nesting.enter(path, named);
    const std::string bytes = read_whole_file(path);
    const std::string extension = path.extension().string();
    const auto read = [&]() -> Scene {
        if (extension == ".toml")
            return parse_project(path, bytes,
                                 [&](const std::filesystem::path& file, const Place& at) {
                                     return read_by_kind(file, at, nesting);
                                 });
        if (extension == ".glb" || extension == ".gltf") return parse_gltf(path, bytes);
        if (extension == ".geom" || looks_like_afit_geometry(bytes))
            return read_afit_with_display(path, bytes);
        if (looks_like_gltf(bytes)) return parse_gltf(path, bytes);
        if (is_lamp_file(path))
            throw Error({path.string(), 0, 0},
                        "a luminaire, not a scene: a project (.toml) places it in one");
        throw Error({path.string(), 0, 0},
                    "not a scene that can be read, expected a project (.toml), glTF (.gltf, .glb) "
                    "or AFIT geometry (.geom)");
    };
    Scene scene = read();
    nesting.leave();
    return scene;
}

}  // namespace

Scene read_scene(const std::filesystem::path& path) {
    Nesting nesting;
    Scene scene = read_by_kind(path, {path.string(), 0, 0}, nesting);
    mend(scene);
    return scene;
}

}  // namespace exitance
