// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/afit_reflectance.h"

#include <fmt/format.h>

#include <ostream>

#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

// The original goes up to 25.
constexpr std::uint32_t most_degrees = 1000;
// Rounding of the two shares as they are written.
constexpr double share_rounding = 1e-6;

}  // namespace

AfitReflectance parse_afit_reflectance(const std::string& file, std::string_view text) {
    TextCursor cursor(file, text);
    AfitReflectance out;
    const auto keyword = [&](const char* word) {
        const std::string expected = std::string("'") + word + "'";
        if (cursor.word(expected) != word) cursor.refuse(expected);
    };
    if (!cursor.next_line())
        throw Error(cursor.here(), "found the end of the file, expected 'lval L Ks s Kd d'");
    keyword("lval");
    const std::uint32_t degrees =
        cursor.count(fmt::format("the highest degree, 0 to {}", most_degrees), 0, most_degrees);
    keyword("Ks");
    out.specular = cursor.number("a share of light, 0 to 1", 0, 1);
    keyword("Kd");
    out.diffuse = cursor.number("a share of light, 0 to 1", 0, 1);
    if (out.specular + out.diffuse > 1 + share_rounding)
        cursor.refuse(fmt::format("Ks + Kd of at most 1, with Ks {:g}", out.specular));
    cursor.end_line("the end of the line");
    for (std::uint32_t l = 0; l <= degrees; ++l) {
        if (!cursor.next_line())
            throw Error(
                cursor.here(),
                fmt::format("found the end of the file, expected a_{} of a_{}", l, degrees));
        out.coefficients.push_back(
            cursor.number(fmt::format("the coefficient a_{}", l), -1e9, 1e9));
        cursor.end_line("one coefficient a line");
    }
    if (cursor.next_line()) cursor.end_line("the end of the file after the last coefficient");
    return out;
}

AfitReflectance read_afit_reflectance(const std::filesystem::path& path) {
    return parse_afit_reflectance(path.string(), read_whole_file(path));
}

void write_afit_reflectance(const AfitReflectance& reflectance, std::ostream& out) {
    out << fmt::format("lval {} Ks {} Kd {}\n", reflectance.coefficients.size() - 1,
                       reflectance.specular, reflectance.diffuse);
    for (const double a : reflectance.coefficients) out << fmt::format("{}\n", a);
}

void apply_afit_reflectances(Scene& scene, const std::filesystem::path& geometry) {
    for (Material& material : scene.materials) {
        if (!material.reflectance_file) continue;
        const std::string name = fmt::format("{}.reflectance", *material.reflectance_file);
        std::filesystem::path path = geometry.parent_path() / geometry.stem();
        path += "." + name;
        std::error_code ignored;
        if (!std::filesystem::exists(path, ignored)) path = geometry.parent_path() / name;
        if (!std::filesystem::exists(path, ignored)) {
            scene.notes.push_back(
                {material.place, fmt::format("there is no {} beside the geometry; its colour alone "
                                             "counts",
                                             name)});
            continue;
        }
        const AfitReflectance read = read_afit_reflectance(path);
        if (read.specular > 0) {
            material.specular = material.reflectance;
            for (double& band : material.specular) band *= read.specular;
        }
        for (double& band : material.reflectance) band *= read.diffuse;
    }
}

}  // namespace exitance
