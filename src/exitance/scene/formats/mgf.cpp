// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/mgf.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>

#include "exitance/math/polygon.h"
#include "exitance/scene/closed_bodies.h"
#include "exitance/scene/formats/include_files.h"
#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/mgf_contexts.h"
#include "exitance/scene/formats/mgf_lines.h"
#include "exitance/scene/formats/mgf_material.h"
#include "exitance/scene/formats/polygon_collector.h"
#include "exitance/scene/formats/similarity_arguments.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

constexpr std::size_t longest_line = 4096;
constexpr std::size_t any = static_cast<std::size_t>(-1);

class MgfReader {
  public:
    MgfReader(const std::filesystem::path& path, std::string text, const ReadOptions& options)
        : options_(options),
          files_(path, std::move(text), options),
          budget_(options),
          collector_(scene_, options, budget_, warnings_) {}

    Scene read() {
        read_file(files_.current());
        if (!known_anything_)
            throw Error({files_.current()->path.string(), 1, 1},
                        "found no entity of MGF, expected lines such as 'm steel =' or 'f a b c'");
        for (const Material& material : scene_.materials)
            if (material.emits()) scene_.quantity = Quantity::photometric;
        scene_.warnings = warnings_.take();
        close_bodies(scene_);
        return std::move(scene_);
    }

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

    void read_file(const std::shared_ptr<const SourceFile>& file) {
        MgfLines* const outer = lines_;
        const std::size_t movings = movings_.size(), objects = objects_.size();
        const std::size_t outer_movings = file_movings_, outer_objects = file_objects_;
        MgfLines lines(file);
        lines_ = &lines;
        file_movings_ = movings;
        file_objects_ = objects;
        while (lines.next()) read_line();
        if (movings_.size() > movings) {
            warn("unclosed xf", fmt::format("{} 'xf' without the 'xf' that ends it, at the end of "
                                            "the file",
                                            movings_.size() - movings));
            placing_ = movings_[movings].outer;
            movings_.resize(movings);
            expect_repetitions();
        }
        if (objects_.size() > objects) {
            warn("unclosed o", fmt::format("{} 'o' without the 'o' that ends it, at the end of the "
                                           "file",
                                           objects_.size() - objects));
            objects_.resize(objects);
        }
        ++naming_;
        file_movings_ = outer_movings;
        file_objects_ = outer_objects;
        lines_ = outer;
    }

    void read_line() {
        budget_.spend_lines(lines_->passed(), [&] { return lines_->place(0); });
        if (lines_->length() > longest_line && !warnings_.seen("long line"))
            warn("long line", fmt::format("a line of {} characters, MGF allows {}",
                                          lines_->length(), longest_line));
        const Words words(lines_->words());
        const auto found = entities().find(words[0]);
        if (found == entities().end()) {
            warn("entity " + std::string(words[0]),
                 fmt::format("{} is no entity of MGF; the line is skipped", in_quotes(words[0])));
            return;
        }
        known_anything_ = true;
        const Entity& entity = found->second;
        const std::size_t count = words.size() - 1;
        if (count < entity.least)
            throw Error(lines_->place(words.size()),
                        fmt::format("found the end of the line, expected {}", entity.arguments));
        if (count > entity.most)
            warn("stray text",
                 fmt::format("{} after '{}' with its arguments ({}) is skipped",
                             in_quotes(words[entity.most + 1]), words[0], entity.arguments));
        (this->*entity.read)(words.subspan(1, std::min(count, entity.most)));
    }

    void warn(const std::string& kind, const std::string& what) {
        warnings_.add(kind, lines_->line_place(), what);
    }
    /// Throws at argument `index` of the current line.
    [[noreturn]] void refuse(std::size_t index, const std::string& expected) const {
        const auto& words = lines_->words();
        throw Error(lines_->place(index + 1),
                    fmt::format("found {}, expected {}",
                                index + 1 < words.size() ? in_quotes(words[index + 1])
                                                         : std::string("the end of the line"),
                                expected));
    }
    double number(Words words, std::size_t i, const char* what, double least, double most) const {
        const auto value = finite_number(words[i]);
        if (!value || *value < least || *value > most) refuse(i, what);
        return *value;
    }

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
    void chromaticity(Words words) {
        const char* expected = "a chromaticity: x at least 0, y above 0, x + y at most 1";
        const double x = number(words, 0, expected, 0, 1), y = number(words, 1, expected, 1e-6, 1);
        if (x + y > 1 + 1e-6) refuse(1, expected);
        colours_.current().xyz = xyz_of_chromaticity(x, y);
    }
    void spectrum(Words words) {
        SampledSpectrum spectrum;
        spectrum.first = number(words, 0, "a wavelength in nm", 1, 1e5);
        spectrum.last = number(words, 1, "a longer wavelength in nm", spectrum.first + 1e-3, 1e5);
        for (std::size_t i = 2; i < words.size(); ++i)
            spectrum.values.push_back(
                number(words, i, "a value of the spectrum, 0 or more", 0, 1e30));
        set_spectrum(spectrum);
    }
    void temperature(Words words) {
        set_spectrum(black_body(number(words, 0, "a temperature of 100 to 1e6 K", 100, 1e6)));
    }
    void set_spectrum(const SampledSpectrum& spectrum) {
        colours_.current().xyz = xyz_of_spectrum(spectrum);
        if (colours_.current().xyz.y > 0) return;
        warn("invisible", "a spectrum without visible light is taken as white");
        colours_.current() = MgfColour{};
    }
    void mix(Words words) {
        Xyz sum{0, 0, 0};
        for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
            const double weight = number(words, i, "a weight, 0 or more", 0, 1e30);
            const MgfColour* part = colours_.find(words[i + 1]);
            if (part == nullptr)
                throw Error(lines_->place(i + 2),
                            fmt::format("there is no colour {}{}", in_quotes(words[i + 1]),
                                        suggestion(std::string(words[i + 1]), colours_.names())));
            sum.x += weight * part->xyz.x;
            sum.y += weight * part->xyz.y;
            sum.z += weight * part->xyz.z;
        }
        if (words.size() % 2 != 0) refuse(words.size(), "a weight and a colour in turn");
        if (!(sum.y > 0)) refuse(0, "weights that are not all zero");
        colours_.current().xyz = {sum.x / sum.y, 1, sum.z / sum.y};
    }

    void material(Words words) {
        enter(materials_, words, "material");
        if (words.size() == 1) return;
        materials_.current().place = lines_->line_place();
        touch();
    }
    void touch() { materials_.current().stamp = ++stamps_; }
    void set_share(MgfShare MgfMaterial::*share, double value) {
        materials_.current().*share = {value, colours_.current().xyz};
        touch();
    }
    static constexpr const char* share_expected = "a share of light, 0 to 1";
    void diffuse_reflection(Words words) {
        set_share(&MgfMaterial::rd, number(words, 0, share_expected, 0, 1));
    }
    void diffuse_transmission(Words words) {
        set_share(&MgfMaterial::td, number(words, 0, share_expected, 0, 1));
    }
    void emission(Words words) {
        set_share(&MgfMaterial::ed,
                  number(words, 0, "an exitance in lm/m², 0 or more", 0, limits::exitance));
    }
    void specular_reflection(Words words) {
        set_share(&MgfMaterial::rs, number(words, 0, share_expected, 0, 1));
        materials_.current().rs_roughness = number(words, 1, "a roughness, 0 or more", 0, 1e6);
    }
    void specular_transmission(Words words) {
        set_share(&MgfMaterial::ts, number(words, 0, share_expected, 0, 1));
        materials_.current().ts_roughness = number(words, 1, "a roughness, 0 or more", 0, 1e6);
    }
    void refraction(Words words) {
        materials_.current().refractive_index =
            number(words, 0, "a refractive index above 0", 1e-3, 1e3);
        number(words, 1, "the imaginary part of a refractive index, 0 or more", 0, 1e6);
        touch();
    }
    void sides(Words words) {
        if (words[0] != "1" && words[0] != "2") refuse(0, "1 or 2 sides");
        materials_.current().two_sided = words[0] == "2";
        touch();
    }

    void vertex(Words words) { enter(vertices_, words, "vertex"); }
    Vec3 vector(Words words, const char* expected) const {
        Vec3 v;
        for (std::size_t i = 0; i < 3; ++i)
            v[i] = number(words, i, expected, -limits::coordinate, limits::coordinate);
        return v;
    }
    void point(Words words) {
        vertices_.current().point = vector(words, "a coordinate, at most 1e9");
    }
    void normal(Words words) {
        vertices_.current().normal = normalized(vector(words, "part of a direction, at most 1e9"));
    }

    // Hierarchy.

    void object(Words words) {
        if (!words.empty()) {
            if (objects_.size() >= 1000)
                throw Error(lines_->place(0), "found 'o' within 'o' more than 1000 deep");
            objects_.push_back(as_utf8(words[0]));
        } else if (objects_.size() > file_objects_) {
            objects_.pop_back();
        } else {
            warn("o", "'o' that ends an object, and none is open");
        }
        ++naming_;
    }

    SimilarityArguments similarity(Words words, std::size_t skipped) {
        const SimilarityArguments out(
            words, [&](std::size_t i) { return lines_->place(skipped + 1 + i); });
        if (out.taken() < words.size())
            refuse(skipped + out.taken(), "-t, -rx, -ry, -rz, -s, -mx, -my, -mz, -i or -a");
        return out;
    }
    void expect_repetitions() {
        // Checked on the first copy of all; from then on they count as they come.
        constexpr std::uint64_t countless = std::uint64_t{1} << 62;
        std::uint64_t times = 1;
        for (const Moving& moving : movings_) {
            if (moving.index > 0) {
                times = 1;
                break;
            }
            times = moving.copies > countless / times ? countless : times * moving.copies;
        }
        budget_.expect_repetitions(times);
    }
    void open(const SimilarityArguments& arguments) {
        if (movings_.size() >= 1000)
            throw Error(lines_->place(0), "found 'xf' within 'xf' more than 1000 deep");
        movings_.push_back({arguments, arguments.copies(), 0, placing_, lines_->mark()});
        expect_repetitions();
        budget_.spend_lines(0, [&] { return lines_->place(0); });
        placing_ = placing_.after(arguments.copy(0));
        ++naming_;
    }
    /// The next copy of the innermost array; false if that was the last.
    bool next_copy() {
        Moving& moving = movings_.back();
        if (++moving.index < moving.copies) {
            placing_ = moving.outer.after(moving.arguments.copy(moving.index));
            expect_repetitions();
            ++naming_;
            return true;
        }
        placing_ = moving.outer;
        movings_.pop_back();
        expect_repetitions();
        ++naming_;
        return false;
    }
    void move(Words words) {
        if (!words.empty()) {
            open(similarity(words, 0));
        } else if (movings_.size() <= file_movings_) {
            warn("xf", "'xf' that ends a transformation, and none is open");
        } else {
            const MgfLines::Mark begin = movings_.back().begin;
            if (next_copy()) lines_->go_to(begin);
        }
    }
    void include(Words words) {
        const std::string name(words[0]);
        open(similarity(words.subspan(1), 1));
        const auto file = files_.enter(name, lines_->place(1));
        do read_file(file);
        while (next_copy());
        files_.leave();
    }
    void luminaire(Words words) {
        warn("ies", fmt::format("the luminaire {} is not read", in_quotes(words[0])));
    }

    // "room/table/leg", with the place in arrays: "room/chair[2]", "lamps[3,0]".
    std::string object_name() const {
        std::string out;
        for (const std::string& object : objects_) out += (out.empty() ? "" : "/") + object;
        std::string indices;
        for (const Moving& moving : movings_)
            if (moving.arguments.is_array())
                for (const std::uint64_t i : moving.arguments.indices(moving.index))
                    indices += (indices.empty() ? "" : ",") + std::to_string(i);
        if (!indices.empty()) out += "[" + indices + "]";
        return out;
    }

    // Geometry.

    // The scene's material of the current one; of one name with other values it is another.
    std::uint32_t scene_material_of_current() {
        const MgfMaterial& now = materials_.current();
        const auto [known, fresh] = made_.try_emplace(now.stamp, 0U);
        if (!fresh) return known->second;
        std::vector<Made>& namesakes = of_name_[materials_.name()];
        for (const Made& other : namesakes)
            if (alike(other.material, now)) return known->second = other.index;
        Material made = scene_material(materials_.name(), now, warnings_);
        if (!namesakes.empty()) {
            const std::string first = made.name;
            made.name += fmt::format(" ({})", namesakes.size() + 1);
            warnings_.add("redefined " + first, now.place,
                          fmt::format("material {} is defined again with other values after it was "
                                      "used; the later is called {}",
                                      in_quotes(first), in_quotes(made.name)));
        }
        known->second = scene_.add_material(std::move(made));
        namesakes.push_back({now, known->second});
        return known->second;
    }

    void start_geometry() {
        const std::uint64_t stamp = materials_.current().stamp;
        if (naming_ == named_ && stamp == surface_stamp_ && started_) return;
        const std::uint32_t material = scene_material_of_current();
        const std::string name = object_name();
        collector_.start_surface(name.empty() ? scene_.materials[material].name : name, material,
                                 lines_->line_place());
        named_ = naming_;
        surface_stamp_ = stamp;
        started_ = true;
    }
    const MgfVertex& vertex_named(std::size_t i, std::string_view name) {
        const MgfVertex* found = vertices_.find(name);
        if (found == nullptr)
            throw Error(lines_->place(i + 1),
                        fmt::format("there is no vertex {}", in_quotes(name)));
        return *found;
    }
    std::vector<Corner> corners(Words words, std::size_t first, std::size_t last) {
        if (last - first > options_.max_corners)
            throw Error(lines_->place(0),
                        fmt::format("found a face of {} corners, expected at most {}; "
                                    "--max-corners raises the limit",
                                    last - first, options_.max_corners));
        std::vector<Corner> out;
        for (std::size_t i = first; i < last; ++i) {
            const MgfVertex& v = vertex_named(i, words[i]);
            out.push_back({v.point, v.normal});
        }
        return out;
    }
    void face(Words words) {
        start_geometry();
        collector_.add_face(corners(words, 0, words.size()), placing_, lines_->line_place());
    }
    void face_with_holes(Words words) {
        start_geometry();
        std::vector<std::vector<Corner>> loops;
        for (std::size_t first = 0; first <= words.size();) {
            const std::size_t end = static_cast<std::size_t>(
                std::find(words.begin() + static_cast<std::ptrdiff_t>(first), words.end(), "-") -
                words.begin());
            if (end - first < 3) refuse(end, "three vertices or more in every loop");
            loops.push_back(corners(words, first, end));
            first = end + 1;
        }
        collector_.add_face_with_holes(loops, placing_, lines_->line_place());
    }

    double radius(Words words, std::size_t i) const {
        return number(words, i, "a radius, at most 1e9", -limits::coordinate, limits::coordinate);
    }
    bool degenerate(bool is, const char* what) {
        if (is)
            warn(std::string("degenerate ") + what,
                 fmt::format("a {} without extent is left out", what));
        return is;
    }
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

    void sphere(Words words) {
        const Vec3 centre = vertex_named(0, words[0]).point;
        const double r = radius(words, 1);
        if (degenerate(r == 0, "sphere")) return;
        add(sphere_facet_count(collector_.facets_per_turn()), r < 0,
            [&](std::uint32_t n) { return sphere_facets(centre, std::abs(r), n); });
    }
    void frustum(const Vec3& from, double r0, const Vec3& to, double r1) {
        add(per_turn(), r0 < 0 || r1 < 0, [&](std::uint32_t n) {
            return frustum_facets(from, std::abs(r0), to, std::abs(r1), n);
        });
    }
    void cylinder(Words words) {
        const Vec3 from = vertex_named(0, words[0]).point, to = vertex_named(2, words[2]).point;
        const double r = radius(words, 1);
        if (degenerate(r == 0 || from == to, "cylinder")) return;
        frustum(from, r, to, r);
    }
    void cone(Words words) {
        const Vec3 from = vertex_named(0, words[0]).point, to = vertex_named(2, words[2]).point;
        const double r0 = radius(words, 1), r1 = radius(words, 3);
        if (r0 * r1 < 0) refuse(3, "radii of the same sign");
        // Without height it is a ring that faces along no axis.
        if (degenerate((r0 == 0 && r1 == 0) || from == to, "cone")) return;
        frustum(from, r0, to, r1);
    }
    void ring(Words words) {
        const MgfVertex& centre = vertex_named(0, words[0]);
        const double inner = number(words, 1, "an inner radius, 0 or more", 0, limits::coordinate);
        const double outer =
            number(words, 2, "an outer radius that is not smaller", inner, limits::coordinate);
        if (centre.normal == Vec3{}) refuse(0, "a vertex with a normal (n)");
        if (degenerate(inner == outer, "ring")) return;
        add(per_turn(), false, [&](std::uint32_t n) {
            return ring_facets(centre.point, centre.normal, inner, outer, n);
        });
    }
    void torus(Words words) {
        const MgfVertex& centre = vertex_named(0, words[0]);
        const double inner = radius(words, 1), outer = radius(words, 2);
        const bool inward = inner < 0 || outer < 0;
        const double sign = inward ? -1 : 1;
        if (sign * inner < 0 || sign * outer < sign * inner)
            refuse(2, "an inner and a larger outer radius, or both negative");
        if (centre.normal == Vec3{}) refuse(0, "a vertex with a normal (n)");
        if (degenerate(inner == outer, "torus")) return;
        add(per_turn() * per_turn(), inward, [&](std::uint32_t n) {
            return torus_facets(centre.point, centre.normal, sign * inner, sign * outer, n);
        });
    }
    // The face given, its copy moved against its normal by the length, and the sides in between;
    // with a negative length all fronts are inside.
    void prism(Words words) {
        const std::vector<Corner> base = corners(words, 0, words.size() - 1);
        const double length = number(words, words.size() - 1, "a length, at most 1e9",
                                     -limits::coordinate, limits::coordinate);
        std::vector<Vec3> outline;
        for (const Corner& corner : base) outline.push_back(corner.point);
        const Vec3 normal = unit_normal(outline);
        if (degenerate(length == 0 || normal == Vec3{}, "prism")) return;
        start_geometry();
        std::vector<Corner> bottom, top;
        for (const Corner& corner : base) {
            bottom.push_back({corner.point, {}});
            top.push_back({corner.point - normal * length, {}});
        }
        std::reverse(top.begin(), top.end());
        const Place place = lines_->line_place();
        collector_.add_face(bottom, placing_, place);
        collector_.add_face(top, placing_, place);
        const std::size_t n = base.size();
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t j = (i + 1) % n;
            const Corner &a = base[i], &b = base[j];
            collector_.add_face(std::array{b, a, Corner{top[n - 1 - i].point, a.normal},
                                           Corner{top[n - 1 - j].point, b.normal}},
                                placing_, place);
        }
    }

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

    std::vector<std::string> objects_;
    std::vector<Moving> movings_;
    std::size_t file_objects_ = 0, file_movings_ = 0;  // open before the current file
    Transform placing_;
    // The surface that is being added to, and whether the object has changed since.
    std::uint64_t naming_ = 0, named_ = 0, surface_stamp_ = 0;
    bool started_ = false;
};

const std::unordered_map<std::string_view, MgfReader::Entity>& MgfReader::entities() {
    using R = MgfReader;
    static const std::unordered_map<std::string_view, Entity> table{
        {"c", {&R::colour, 0, 3, "name, = and a template, or less"}},
        {"cct", {&R::temperature, 1, 1, "a temperature in K"}},
        {"cmix", {&R::mix, 2, any, "weights and names of colours in turn"}},
        {"cone", {&R::cone, 4, 4, "vertex, radius, vertex, radius"}},
        {"cspec", {&R::spectrum, 4, any, "two wavelengths and two values or more"}},
        {"cxy", {&R::chromaticity, 2, 2, "a chromaticity x y"}},
        {"cyl", {&R::cylinder, 3, 3, "vertex, radius, vertex"}},
        {"ed", {&R::emission, 1, 1, "an exitance in lm/m²"}},
        {"f", {&R::face, 3, any, "three vertices or more"}},
        {"fh", {&R::face_with_holes, 3, any, "three vertices or more, and holes after '-'"}},
        {"i", {&R::include, 1, any, "the name of a file"}},
        {"ies", {&R::luminaire, 1, any, "the name of a file"}},
        {"ir", {&R::refraction, 2, 2, "real and imaginary refractive index"}},
        {"m", {&R::material, 0, 3, "name, = and a template, or less"}},
        {"n", {&R::normal, 3, 3, "a direction x y z"}},
        {"o", {&R::object, 0, 1, "a name, or nothing"}},
        {"p", {&R::point, 3, 3, "coordinates x y z"}},
        {"prism", {&R::prism, 4, any, "three vertices or more and a length"}},
        {"rd", {&R::diffuse_reflection, 1, 1, "a share of light"}},
        {"ring", {&R::ring, 3, 3, "vertex, inner radius, outer radius"}},
        {"rs", {&R::specular_reflection, 2, 2, "a share of light and a roughness"}},
        {"sides", {&R::sides, 1, 1, "1 or 2"}},
        {"sph", {&R::sphere, 2, 2, "vertex, radius"}},
        {"td", {&R::diffuse_transmission, 1, 1, "a share of light"}},
        {"torus", {&R::torus, 3, 3, "vertex, inner radius, outer radius"}},
        {"ts", {&R::specular_transmission, 2, 2, "a share of light and a roughness"}},
        {"v", {&R::vertex, 0, 3, "name, = and a template, or less"}},
        {"xf", {&R::move, 0, any, "a transformation, or nothing"}},
    };
    return table;
}

}  // namespace

Scene parse_mgf(const std::filesystem::path& path, std::string text, const ReadOptions& options) {
    return MgfReader(path, std::move(text), options).read();
}

}  // namespace exitance
