// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/read.h"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/scene/formats/afit.h"
#include "exitance/scene/formats/afit_reflectance.h"
#include "exitance/scene/formats/general_geometry.h"
#include "exitance/scene/formats/gltf.h"
#include "exitance/scene/formats/lamp_file.h"
#include "exitance/scene/formats/mgf.h"
#include "exitance/scene/formats/project.h"
#include "exitance/scene/formats/rad.h"
#include "exitance/scene/formats/source_text.h"
#include "exitance/scene/formats/view3d.h"
#include "exitance/scene/mend.h"

namespace exitance {

namespace {

/// Files that are open one inside the other, and how many there were in all: projects that name
/// each other twice and again must come to an end.
class Nesting {
  public:
    explicit Nesting(const ReadOptions& options) : options_(options) {}

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
        if (open_.size() >= options_.max_include_depth)
            throw Error(named, fmt::format("projects name each other more than {} deep; "
                                           "--max-include-depth raises the limit",
                                           options_.max_include_depth));
        if (++count_ > options_.max_files)
            throw Error(named, fmt::format("projects name files too often, more than {} times; "
                                           "--max-files raises the limit",
                                           options_.max_files));
        open_.push_back(canonical);
    }
    void leave() { open_.pop_back(); }
    /// What is asked of reading the file entered last.
    ReadOptions options() const {
        ReadOptions out = options_;
        if (open_.size() > 1) out.held_in = open_[0].parent_path();
        return out;
    }

  private:
    const ReadOptions& options_;
    std::vector<std::filesystem::path> open_;
    std::size_t count_ = 0;
};

// A display file beside a geometry file of the same stem says who looks.
Scene read_afit_with_display(const std::filesystem::path& path, std::string_view text) {
    Scene scene = parse_afit_geometry(path.string(), text);
    apply_afit_reflectances(scene, path);
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
    const std::string extension = lower_extension(path);
    const ReadOptions options = nesting.options();
    std::string bytes = read_whole_file(path, options.most_bytes());
    const auto read = [&]() -> Scene {
        if (extension == ".toml")
            return parse_project(
                path, bytes,
                [&](const std::filesystem::path& file, const Place& at) {
                    return read_by_kind(file, at, nesting);
                },
                options);
        if (extension == ".glb" || extension == ".gltf") return parse_gltf(path, bytes, options);
        if (extension == ".mgf") return parse_mgf(path, std::move(bytes), options);
        if (extension == ".rad") return parse_rad(path, std::move(bytes), options);
        if (extension == ".vs3") return parse_view3d(path, bytes, options);
        if (is_general_geometry(path)) return parse_general_geometry(path, bytes, options);
        if (extension == ".geom" || looks_like_afit_geometry(bytes))
            return read_afit_with_display(path, bytes);
        if (looks_like_gltf(bytes)) return parse_gltf(path, bytes, options);
        if (is_lamp_file(path))
            throw Error({path.string(), 0, 0},
                        "a luminaire, not a scene: a project (.toml) places it in one");
        throw Error(
            {path.string(), 0, 0},
            "not a scene that can be read, expected a project (.toml), glTF (.gltf, .glb), "
            "MGF (.mgf), Radiance (.rad), AFIT geometry (.geom), View3D (.vs3), .obj, .ply, "
            ".stl, .fbx, .dae, .3ds or .ifc");
    };
    Scene scene = read();
    nesting.leave();
    return scene;
}

}  // namespace

Scene read_scene(const std::filesystem::path& path, const ReadOptions& options) {
    Nesting nesting(options);
    Scene scene = read_by_kind(path, {path.string(), 0, 0}, nesting);
    mend(scene);
    if (options.strict && !scene.warnings.empty())
        throw Error(scene.warnings[0].place,
                    fmt::format("{} (--strict; {} warnings in all)", scene.warnings[0].what,
                                scene.warnings.size()));
    return scene;
}

}  // namespace exitance
