// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "exitance/math/polygon.h"
#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/mgf_material.h"
#include "exitance/scene/formats/mgf_reader.h"

namespace exitance {

std::uint32_t MgfReader::scene_material_of_current() {
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

void MgfReader::start_geometry() {
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

const MgfVertex& MgfReader::vertex_named(std::size_t i, std::string_view name) {
    const MgfVertex* found = vertices_.find(name);
    if (found == nullptr)
        throw Error(lines_->place(i + 1), fmt::format("there is no vertex {}", in_quotes(name)));
    return *found;
}

std::vector<Corner> MgfReader::corners(Words words, std::size_t first, std::size_t last) {
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

void MgfReader::face(Words words) {
    start_geometry();
    collector_.add_face(corners(words, 0, words.size()), placing_, lines_->line_place());
}

void MgfReader::face_with_holes(Words words) {
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

double MgfReader::radius(Words words, std::size_t i) const {
    return number(words, i, "a radius, at most 1e9", -limits::coordinate, limits::coordinate);
}

bool MgfReader::degenerate(bool is, const char* what) {
    if (is)
        warn(std::string("degenerate ") + what,
             fmt::format("a {} without extent is left out", what));
    return is;
}

void MgfReader::sphere(Words words) {
    const Vec3 centre = vertex_named(0, words[0]).point;
    const double r = radius(words, 1);
    if (degenerate(r == 0, "sphere")) return;
    add(sphere_facet_count(collector_.facets_per_turn()), r < 0,
        [&](std::uint32_t n) { return sphere_facets(centre, std::abs(r), n); });
}

void MgfReader::frustum(const Vec3& from, double r0, const Vec3& to, double r1) {
    add(per_turn(), r0 < 0 || r1 < 0,
        [&](std::uint32_t n) { return frustum_facets(from, std::abs(r0), to, std::abs(r1), n); });
}

void MgfReader::cylinder(Words words) {
    const Vec3 from = vertex_named(0, words[0]).point, to = vertex_named(2, words[2]).point;
    const double r = radius(words, 1);
    if (degenerate(r == 0 || from == to, "cylinder")) return;
    frustum(from, r, to, r);
}

void MgfReader::cone(Words words) {
    const Vec3 from = vertex_named(0, words[0]).point, to = vertex_named(2, words[2]).point;
    const double r0 = radius(words, 1), r1 = radius(words, 3);
    if (r0 * r1 < 0) refuse(3, "radii of the same sign");
    // Without height it is a ring that faces along no axis.
    if (degenerate((r0 == 0 && r1 == 0) || from == to, "cone")) return;
    frustum(from, r0, to, r1);
}

void MgfReader::ring(Words words) {
    const MgfVertex& centre = vertex_named(0, words[0]);
    const double inner = number(words, 1, "an inner radius, 0 or more", 0, limits::coordinate);
    const double outer =
        number(words, 2, "an outer radius that is not smaller", inner, limits::coordinate);
    if (centre.normal == Vec3{}) refuse(0, "a vertex with a normal (n)");
    if (degenerate(inner == outer, "ring")) return;
    add(per_turn(), false,
        [&](std::uint32_t n) { return ring_facets(centre.point, centre.normal, inner, outer, n); });
}

void MgfReader::torus(Words words) {
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

void MgfReader::prism(Words words) {
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

}  // namespace exitance
