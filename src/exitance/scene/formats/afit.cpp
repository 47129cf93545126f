// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/afit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

struct Counts {
    std::uint32_t points = 0, polygons = 0, attributes = 0;
};

struct Selection {
    bool clockwise = false, both_sides = false;
};

Vec3 read_vector(TextCursor& cursor, const std::string& what, double most) {
    const std::string expected =
        fmt::format("{} (a number between -{:g} and {:g})", what, most, most);
    Vec3 v;
    for (std::size_t i = 0; i < 3; ++i) v[i] = cursor.number(expected, -most, most);
    return v;
}

Spectrum read_colour(TextCursor& cursor, const std::string& what, double most) {
    const std::string expected = fmt::format("{} (three numbers from 0 to {:g})", what, most);
    Spectrum colour(3);
    for (double& band : colour) band = cursor.number(expected, 0, most);
    return colour;
}

// Lines 2 and 3: the selection, which may be missing, and the counts.
std::pair<Selection, Counts> read_header(TextCursor& cursor) {
    Selection selection;
    Counts counts;
    const std::array<std::string, 7> words{"points", "patches", "attributes", "ccw",
                                           "cw",     "purge",   "nopurge"};
    bool counted = false;
    while (!counted) {
        if (!cursor.next_line())
            throw Error(cursor.here(),
                        "found the end of the file, expected 'points n patches n attributes n'");
        while (!cursor.line_ended()) {
            const std::string word(cursor.word(""));
            if (word == "ccw" || word == "cw")
                selection.clockwise = word == "cw";
            else if (word == "purge" || word == "nopurge")
                selection.both_sides = word == "nopurge";
            else if (word == "points") {
                const std::string how_many = fmt::format("a count from 0 to {}", limits::elements);
                counts.points = cursor.count(how_many, 0, limits::elements);
                if (cursor.word("'patches'") != "patches") cursor.refuse("'patches'");
                counts.polygons = cursor.count(how_many, 0, limits::elements);
                if (cursor.word("'attributes'") != "attributes") cursor.refuse("'attributes'");
                counts.attributes = cursor.count(how_many, 0, limits::elements);
                cursor.end_line("the end of the line");
                counted = true;
            } else
                cursor.refuse("ccw, cw, purge, nopurge or points" + suggestion(word, words));
        }
    }
    return {selection, counts};
}

// Nothing is reserved from the counts: the lists grow with the lines that are really there.
void next_of(TextCursor& cursor, const char* what, std::uint32_t i, std::uint32_t count) {
    if (!cursor.next_line())
        throw Error(cursor.here(), fmt::format("found the end of the file, expected {} {} of {}",
                                               what, i + 1, count));
}

void read_points(TextCursor& cursor, std::uint32_t count, Scene& scene) {
    for (std::uint32_t i = 0; i < count; ++i) {
        next_of(cursor, "point", i, count);
        const Vec3 point = read_vector(cursor, "a coordinate", limits::coordinate);
        Vec3 normal;
        if (cursor.take("normal"))
            normal = normalized(read_vector(cursor, "a normal", limits::coordinate));
        cursor.end_line(
            fmt::format("'normal' or the end of the line (point {} of {})", i + 1, count));
        scene.add_point(point, normal);
    }
}

void read_polygons(TextCursor& cursor, const Counts& counts, bool clockwise, Scene& scene) {
    const std::string index = fmt::format("the number of a point, 1 to {}", counts.points);
    const std::string attribute =
        fmt::format("the number of an attribute, 1 to {}", counts.attributes);
    const std::string patches = fmt::format("a number of patches, 1 to {}", limits::patches);
    for (std::uint32_t i = 0; i < counts.polygons; ++i) {
        next_of(cursor, "polygon", i, counts.polygons);
        Polygon polygon;
        polygon.patches = 1;
        const std::uint32_t corners = cursor.count("the number of corners, 3 or 4", 3, 4);
        polygon.line = static_cast<std::uint32_t>(cursor.place().line);
        for (std::uint32_t c = 0; c < corners; ++c)
            polygon.corners[clockwise ? corners - 1 - c : c] =
                cursor.count(index, 1, counts.points) - 1;
        if (cursor.take("attribute"))
            polygon.surface = cursor.count(attribute, 1, counts.attributes) - 1;
        if (cursor.take("patch")) polygon.patches = cursor.count(patches, 1, limits::patches);
        cursor.end_line(
            fmt::format("'attribute', 'patch' or the end of the line (polygon {} of {})", i + 1,
                        counts.polygons));
        scene.polygons.push_back(polygon);
    }
}

void read_attributes(TextCursor& cursor, std::uint32_t count, bool both_sides, Scene& scene) {
    for (std::uint32_t i = 0; i < count; ++i) {
        next_of(cursor, "attribute", i, count);
        Material material;
        material.name = fmt::format("attribute {}", i + 1);
        if (cursor.word("'color'") != "color") cursor.refuse("'color'");
        material.place = cursor.place();
        material.reflectance = read_colour(cursor, "a reflectance", 1);
        material.exitance = cursor.take("emit")
                                ? read_colour(cursor, "an exitance", limits::exitance)
                                : Spectrum(3, 0.0);
        if (cursor.take("material"))
            material.reflectance_file =
                static_cast<int>(cursor.count("the number of a reflectance file", 0, 1'000'000));
        cursor.end_line(fmt::format(
            "'emit', 'material' or the end of the line (attribute {} of {})", i + 1, count));
        // A lamp keeps its one lit side, or its flux would double against the original.
        material.two_sided = both_sides && !material.emits();
        const Place place = material.place;
        const std::string name = material.name;
        scene.surfaces[scene.add_surface(name, scene.add_material(std::move(material)))].place =
            place;
    }
}

}  // namespace

bool looks_like_afit_geometry(std::string_view text) {
    TextCursor cursor("", text);
    cursor.rest_of_line();
    for (int line = 0; line < 2 && cursor.next_line(); ++line) {
        if (cursor.take("points")) return true;
        cursor.rest_of_line();
    }
    return false;
}

Scene parse_afit_geometry(const std::string& file, std::string_view text) {
    TextCursor cursor(file, text);
    Scene scene;
    scene.title = as_utf8(cursor.rest_of_line());
    const auto [selection, counts] = read_header(cursor);
    if (counts.polygons > 0 && counts.attributes == 0)
        throw Error(cursor.place(), "found no attributes, expected at least one for the polygons");
    read_points(cursor, counts.points, scene);
    read_polygons(cursor, counts, selection.clockwise, scene);
    read_attributes(cursor, counts.attributes, selection.both_sides, scene);
    if (cursor.next_line()) cursor.end_line("the end of the file after the last attribute");
    return scene;
}

Scene read_afit_geometry(const std::filesystem::path& path) {
    return parse_afit_geometry(path.string(), read_whole_file(path));
}

Camera camera_of(const AfitDisplay& display) {
    const auto tan_half = [](double degrees) {
        return std::tan(degrees * std::numbers::pi / 360.0);
    };
    Camera camera;
    camera.eye = display.eye;
    camera.look_at = display.look_at;
    camera.up = display.up;
    camera.fov_y = display.fov_y;
    camera.aspect = tan_half(display.fov_x) / tan_half(display.fov_y);
    camera.near = display.near;
    camera.far = display.far;
    return camera;
}

AfitDisplay parse_afit_display(const std::string& file, std::string_view text) {
    const std::array<std::string, 12> words{"eye",  "lookat",   "up",      "fovx",
                                            "fovy", "near",     "far",     "xres",
                                            "yres", "diameter", "ambient", "threshold"};
    const std::string angle = "an angle in degrees, 0.01 to 179";
    const std::string distance = "a distance above 0";
    const std::string pixels = "a number of pixels, 1 to 65536";
    TextCursor cursor(file, text);
    AfitDisplay display;
    display.comment = as_utf8(cursor.rest_of_line());
    std::array<bool, 12> seen{};
    Place eye, up;
    while (cursor.next_line()) {
        const std::string word(cursor.word(""));
        const auto found = std::find(words.begin(), words.end(), word);
        if (found == words.end())
            cursor.refuse("a word of a display file" + suggestion(word, words));
        bool& before = seen[static_cast<std::size_t>(found - words.begin())];
        if (before) throw Error(cursor.place(), in_quotes(word) + " stands here a second time");
        before = true;
        if (word == "eye") {
            eye = cursor.place();
            display.eye = read_vector(cursor, "a coordinate", limits::coordinate);
        } else if (word == "lookat")
            display.look_at = read_vector(cursor, "a coordinate", limits::coordinate);
        else if (word == "up") {
            up = cursor.place();
            display.up = read_vector(cursor, "a direction", limits::coordinate);
        } else if (word == "fovx")
            display.fov_x = cursor.number(angle, 0.01, 179);
        else if (word == "fovy")
            display.fov_y = cursor.number(angle, 0.01, 179);
        else if (word == "near")
            display.near = cursor.number(distance, 1e-9, limits::coordinate);
        else if (word == "far")
            display.far = cursor.number(distance, 1e-9, limits::coordinate);
        else if (word == "xres")
            display.width = cursor.count(pixels, 1, 65536);
        else if (word == "yres")
            display.height = cursor.count(pixels, 1, 65536);
        else if (word == "diameter")
            display.diameter = cursor.number("a diameter, 0 or more", 0, limits::coordinate);
        else if (word == "ambient")
            display.ambient = cursor.count("0 or 1", 0, 1) == 1;
        else if (word == "threshold")
            display.threshold = cursor.number("a threshold, 0 or more", 0, 1e9);
    }
    for (const std::size_t needed : {std::size_t{0}, std::size_t{1}})
        if (!seen[needed])
            throw Error(cursor.here(),
                        "found the end of the file, expected '" + words[needed] + "'");
    const Vec3 view = display.look_at - display.eye;
    if (length(view) == 0)
        throw Error(eye, "eye and lookat are the same point, expected two different ones");
    if (length(cross(normalized(view), normalized(display.up))) < 1e-9)
        throw Error(seen[2] ? up : eye,
                    "up is along the line of sight, expected another direction");
    if (display.near && display.far && *display.far <= *display.near)
        throw Error(cursor.here(), "far is not beyond near");
    return display;
}

AfitDisplay read_afit_display(const std::filesystem::path& path) {
    return parse_afit_display(path.string(), read_whole_file(path));
}

}  // namespace exitance
