// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/mgf.h"

#include <cmath>

#include "exitance/scene/closed_bodies.h"
#include "exitance/scene/formats/lamp_file.h"
#include "exitance/scene/formats/mgf_reader.h"

namespace exitance {

namespace {

constexpr std::size_t longest_line = 4096;
constexpr std::size_t any = static_cast<std::size_t>(-1);

// So much more area across y than across z: floors, ceilings and table tops lie there.
constexpr double clearly = 1.5;

// The format does not say what is up: z by custom, or y where more surface lies level then.
Vec3 up_of(const Scene& scene) {
    constexpr double straight = 0.999;
    double across_y = 0, across_z = 0;
    for (const Polygon& polygon : scene.polygons) {
        const Vec3 normal = scene.normal(polygon);
        const double here = scene.area(polygon);
        if (std::abs(normal.y) > straight) across_y += here;
        if (std::abs(normal.z) > straight) across_z += here;
    }
    return across_y > clearly * across_z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
}

}  // namespace

Scene MgfReader::read() {
    read_file(files_.current());
    if (!known_anything_)
        throw Error({files_.current()->path.string(), 1, 1},
                    "found no entity of MGF, expected lines such as 'm steel =' or 'f a b c'");
    for (const Material& material : scene_.materials)
        if (material.emits()) scene_.quantity = Quantity::photometric;
    if (!scene_.luminaires.empty()) scene_.quantity = Quantity::photometric;
    scene_.up = up_of(scene_);
    warnings_.tell(scene_);
    close_bodies(scene_);
    return std::move(scene_);
}

void MgfReader::read_file(const std::shared_ptr<const SourceFile>& file) {
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

void MgfReader::read_line() {
    budget_.spend_lines(lines_->passed(), [&] { return lines_->place(0); });
    if (lines_->length() > longest_line && !warnings_.seen("long line"))
        warn("long line",
             fmt::format("a line of {} characters, MGF allows {}", lines_->length(), longest_line));
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

void MgfReader::warn(const std::string& kind, const std::string& what) {
    warnings_.add(kind, lines_->line_place(), what);
}

void MgfReader::refuse(std::size_t index, const std::string& expected) const {
    const auto& words = lines_->words();
    throw Error(lines_->place(index + 1),
                fmt::format("found {}, expected {}",
                            index + 1 < words.size() ? in_quotes(words[index + 1])
                                                     : std::string("the end of the line"),
                            expected));
}

double MgfReader::number(Words words, std::size_t i, const char* what, double least,
                         double most) const {
    const auto value = finite_number(words[i]);
    if (!value || *value < least || *value > most) refuse(i, what);
    return *value;
}

void MgfReader::object(Words words) {
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

SimilarityArguments MgfReader::similarity(Words words, std::size_t skipped) {
    const SimilarityArguments out(words,
                                  [&](std::size_t i) { return lines_->place(skipped + 1 + i); });
    if (out.taken() < words.size())
        refuse(skipped + out.taken(), "-t, -rx, -ry, -rz, -s, -mx, -my, -mz, -i or -a");
    return out;
}

void MgfReader::expect_repetitions() {
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

void MgfReader::open(const SimilarityArguments& arguments) {
    if (movings_.size() >= 1000)
        throw Error(lines_->place(0), "found 'xf' within 'xf' more than 1000 deep");
    movings_.push_back({arguments, arguments.copies(), 0, placing_, lines_->mark()});
    expect_repetitions();
    budget_.spend_lines(0, [&] { return lines_->place(0); });
    placing_ = placing_.after(arguments.copy(0));
    ++naming_;
}

bool MgfReader::next_copy() {
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

void MgfReader::move(Words words) {
    if (!words.empty()) {
        open(similarity(words, 0));
    } else if (movings_.size() <= file_movings_) {
        warn("xf", "'xf' that ends a transformation, and none is open");
    } else {
        const MgfLines::Mark begin = movings_.back().begin;
        if (next_copy()) lines_->go_to(begin);
    }
}

void MgfReader::include(Words words) {
    const std::string name(words[0]);
    open(similarity(words.subspan(1), 1));
    const auto file = files_.enter(name, lines_->place(1));
    do read_file(file);
    while (next_copy());
    files_.leave();
}

void MgfReader::luminaire(Words words) {
    std::size_t options = 1;
    double multiplier = 1;
    if (words.size() > 1 && words[1] == "-m") {
        if (words.size() < 3) refuse(2, "a multiplier, 0 or more");
        multiplier = number(words, 2, "a multiplier, 0 or more", 0, 1e9);
        options = 3;
    }
    const std::filesystem::path path = files_.resolve(std::string(words[0]), lines_->place(1));
    auto& photometry = photometries_[path];
    if (!photometry) {
        try {
            LampFile lamp = read_lamp_file(path, 1, options_);
            for (const Problem& problem : lamp.warnings)
                warnings_.add(problem.place.text() + problem.what, problem.place, problem.what);
            photometry = std::make_shared<const Photometry>(std::move(lamp.photometry));
        } catch (const Error& error) {
            throw Error(lines_->place(1), fmt::format("the luminaire {} cannot be read: {}",
                                                      in_quotes(words[0]), error.what()));
        }
    }
    open(similarity(words.subspan(options), options));
    do {
        budget_.spend_lines(1, [&] { return lines_->place(0); });
        Luminaire lamp;
        lamp.name = object_name();
        if (lamp.name.empty()) lamp.name = as_utf8(path.stem().string());
        lamp.photometry = photometry;
        lamp.position = placing_.point({});
        lamp.c0 = normalized(placing_.vector({1, 0, 0}));
        lamp.nadir = normalized(placing_.vector({0, 0, -1}));
        lamp.multiplier = multiplier;
        lamp.place = lines_->line_place();
        if (placing_.determinant() < 0 && !warnings_.seen("mirrored lamp"))
            warn("mirrored lamp", fmt::format("the luminaire {} is mirrored; its distribution is "
                                              "turned instead",
                                              in_quotes(words[0])));
        scene_.luminaires.push_back(std::move(lamp));
    } while (next_copy());
}

std::string MgfReader::object_name() const {
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

Scene parse_mgf(const std::filesystem::path& path, std::string text, const ReadOptions& options) {
    return MgfReader(path, std::move(text), options).read();
}

}  // namespace exitance
