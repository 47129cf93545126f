// SPDX-License-Identifier: Apache-2.0
// The reader of MGF: one function per entity. mgf.cpp has lines and hierarchy, mgf_contexts.cpp
// colours, materials and vertices, mgf_surfaces.cpp what has an area.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "exitance/scene/formats/include_files.h"
#include "exitance/scene/formats/mgf_contexts.h"
#include "exitance/scene/formats/mgf_lines.h"
#include "exitance/scene/formats/polygon_collector.h"
#include "exitance/scene/formats/similarity_arguments.h"
#include "exitance/scene/formats/source_text.h"
#include "exitance/scene/luminaire.h"

namespace exitance {

class MgfReader {
  public:
    MgfReader(const std::filesystem::path& path, std::string text, const ReadOptions& options)
        : options_(options),
          files_(path, std::move(text), options),
          budget_(options),
          collector_(scene_, options, budget_, warnings_) {}

    Scene read();

  private:
    using Words = std::span<const std::string_view>;
    struct Entity {
        void (MgfReader::*read)(Words);
        std::size_t least, most;  // arguments
        const char* arguments;
    };

    // xf … xf, or the file of an i: what lies inside is moved, maybe in several copies.
    struct Moving {
        SimilarityArguments arguments;
        std::uint64_t copies = 1, index = 0;
        Transform outer;
        MgfLines::Mark begin{};
    };

    static const std::unordered_map<std::string_view, Entity>& entities();

    void read_file(const std::shared_ptr<const SourceFile>& file);
    void read_line();
    void warn(const std::string& kind, const std::string& what);
    /// Throws at argument `index` of the current line.
    [[noreturn]] void refuse(std::size_t index, const std::string& expected) const;
    double number(Words words, std::size_t i, const char* what, double least, double most) const;

    // Contexts.

    template <class T>
    void enter(MgfContexts<T>& contexts, Words words, const char* what) {
        using Entry = typename MgfContexts<T>::Entry;
        switch (contexts.enter(words)) {
            case Entry::malformed:
                refuse(1, "'=' with blanks around it");
            case Entry::unknown:
                throw Error(lines_->place(words.size() == 1 ? 1 : 3),
                            fmt::format("there is no {} {}{}", what, in_quotes(contexts.missing()),
                                        suggestion(contexts.missing(), contexts.names())));
            default:
                return;
        }
    }

    void colour(Words words) { enter(colours_, words, "colour"); }
    void chromaticity(Words words);
    void spectrum(Words words);
    void temperature(Words words);
    void set_spectrum(const SampledSpectrum& spectrum);
    void mix(Words words);

    void material(Words words);
    void touch() { materials_.current().stamp = ++stamps_; }
    void set_share(MgfShare MgfMaterial::*share, double value);
    static constexpr const char* share_expected = "a share of light, 0 to 1";
    void diffuse_reflection(Words words);
    void diffuse_transmission(Words words);
    void emission(Words words);
    void specular_reflection(Words words);
    void specular_transmission(Words words);
    void refraction(Words words);
    void sides(Words words);

    void vertex(Words words) { enter(vertices_, words, "vertex"); }
    Vec3 vector(Words words, const char* expected) const;
    void point(Words words);
    void normal(Words words);

    // Hierarchy.

    void object(Words words);

    SimilarityArguments similarity(Words words, std::size_t skipped);
    void expect_repetitions();
    void open(const SimilarityArguments& arguments);
    /// The next copy of the innermost array; false if that was the last.
    bool next_copy();
    void move(Words words);
    void include(Words words);
    // ies file [-m multiplier] [transformation]: nadir along −z, C0 along x.
    void luminaire(Words words);

    // "room/table/leg", with the place in arrays: "room/chair[2]", "lamps[3,0]".
    std::string object_name() const;

    // Geometry.

    // The scene's material of the current one; of one name with other values it is another.
    std::uint32_t scene_material_of_current();

    void start_geometry();
    const MgfVertex& vertex_named(std::size_t i, std::string_view name);
    std::vector<Corner> corners(Words words, std::size_t first, std::size_t last);
    void face(Words words);
    void face_with_holes(Words words);

    double radius(Words words, std::size_t i) const;
    bool degenerate(bool is, const char* what);
    /// `count` facets are checked against the limit before `make` makes them.
    template <class Make>
    void add(std::uint64_t count, bool inward, const Make& make) {
        start_geometry();
        budget_.spend_polygons(count, [&] { return lines_->line_place(); });
        Facets facets = make(collector_.facets_per_turn());
        if (inward) facets.turn_round();
        collector_.add_facets(facets, placing_, lines_->line_place());
    }
    std::uint64_t per_turn() const { return collector_.facets_per_turn(); }

    void sphere(Words words);
    void frustum(const Vec3& from, double r0, const Vec3& to, double r1);
    void cylinder(Words words);
    void cone(Words words);
    void ring(Words words);
    void torus(Words words);
    // The face given, its copy moved against its normal by the length, and the sides in between;
    // with a negative length all fronts are inside.
    void prism(Words words);

    const ReadOptions& options_;
    IncludeFiles files_;
    Scene scene_;
    ReadWarnings warnings_;
    ReadBudget budget_;
    PolygonCollector collector_;
    MgfLines* lines_ = nullptr;
    bool known_anything_ = false;

    MgfContexts<MgfColour> colours_;
    MgfContexts<MgfMaterial> materials_;
    MgfContexts<MgfVertex> vertices_;
    std::uint64_t stamps_ = 0;
    std::unordered_map<std::uint64_t, std::uint32_t> made_;  // scene materials by stamp
    struct Made {
        MgfMaterial material;
        std::uint32_t index;
    };
    std::map<std::string, std::vector<Made>> of_name_;

    std::map<std::filesystem::path, std::shared_ptr<const Photometry>> photometries_;
    std::vector<std::string> objects_;
    std::vector<Moving> movings_;
    std::size_t file_objects_ = 0, file_movings_ = 0;  // open before the current file
    Transform placing_;
    // The surface that is being added to, and whether the object has changed since.
    std::uint64_t naming_ = 0, named_ = 0, surface_stamp_ = 0;
    bool started_ = false;
};

}  // namespace exitance
