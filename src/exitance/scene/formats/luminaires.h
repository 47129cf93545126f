// SPDX-License-Identifier: Apache-2.0
// [[luminaire]] of a lighting project.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "exitance/scene/formats/lamp_file.h"
#include "exitance/scene/formats/toml_table.h"
#include "exitance/scene/read_options.h"
#include "exitance/scene/scene.h"

namespace exitance {

/// Adds the lamps of a project: those with an area as a material and a surface of their own, those
/// with a photometric file, points and spots as luminaires.
class LuminaireReader {
  public:
    /// Files are looked up in `folder`.
    LuminaireReader(Scene& scene, std::filesystem::path folder, const ReadOptions& options)
        : scene_(scene), folder_(std::move(folder)), options_(options) {}

    /// One table: a lamp, or rows and columns of it. Throws Error(bad_input).
    void add(const TomlTable& table);

  private:
    void add_area(const TomlTable& table, const std::string& name, const Vec3& position);
    void add_source(const TomlTable& table, const std::string& name, const Vec3& position);
    std::shared_ptr<const Photometry> photometry(const TomlTable& table);
    void give_housing(Luminaire& luminaire, const Vec3& size);
    void add_box(const Luminaire& luminaire, const Vec3& size, double above);

    Scene& scene_;
    std::filesystem::path folder_;
    const ReadOptions& options_;
    std::uint64_t lamps_ = 0;                                         ///< so far
    std::map<std::string, std::shared_ptr<const Photometry>> files_;  ///< by path and set of lamps
    std::map<const Photometry*, std::shared_ptr<const Photometry>> housed_;  ///< with a housing
};

}  // namespace exitance
