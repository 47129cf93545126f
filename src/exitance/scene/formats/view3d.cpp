// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/view3d.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

#include "exitance/math/polygon.h"
#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/polygon_collector.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

constexpr std::uint32_t most_id = 0x7fffffffU;
// Share of a base's area by which what is left of it may differ from base − subsurfaces.
constexpr double area_share = 1e-6;

struct Entry {
    std::uint32_t id = 0, base = 0, combine = 0;  // ids; 0 = none
    FormFactorRole role = FormFactorRole::normal;
    std::vector<Corner> corners;
    double emissivity = 1;
    std::string name;
    Place place;
};

class View3dReader {
  public:
    View3dReader(const std::filesystem::path& path, std::string_view text,
                 const ReadOptions& options)
        : cursor_(path.string(), text),
          budget_(options),
          collector_(scene_, options, budget_, warnings_) {
        scene_.title = as_utf8(path.stem().string());
    }

    Scene read() {
        bool ended = false;
        while (!ended && cursor_.next_line()) ended = line();
        build();
        warnings_.tell(scene_);
        return std::move(scene_);
    }

  private:
    // True at the line that ends the data.
    bool line() {
        const std::string word(cursor_.word(""));
        budget_.spend_lines(1, [&] { return cursor_.place(); });
        switch (word[0]) {
            case '!':
            case '/':
                break;
            case 'T':
            case 't':
                scene_.title = cursor_.line_ended() ? "" : as_utf8(cursor_.rest_of_line());
                return false;
            case 'C':
            case 'c':
                options();
                return false;
            case 'F':
            case 'f':
                format();
                break;
            case 'V':
            case 'v':
                vertex();
                break;
            case 'S':
            case 's':
                surface(FormFactorRole::normal);
                break;
            case 'M':
            case 'm':
                surface(FormFactorRole::mask);
                break;
            case 'N':
            case 'n':
                surface(FormFactorRole::null);
                break;
            case 'O':
            case 'o':
                surface(FormFactorRole::obstruction);
                break;
            case 'E':
            case 'e':
                return true;
            default:
                cursor_.refuse("T, C, F, V, S, M, N, O, E or a comment (!)");
        }
        if (!cursor_.line_ended()) cursor_.rest_of_line();
        return false;
    }

    void options() {
        while (!cursor_.line_ended()) {
            const std::string_view word = cursor_.word("");
            if (word[0] == '!') {
                if (!cursor_.line_ended()) cursor_.rest_of_line();
                return;
            }
            const std::size_t sign = word.find('=');
            if (sign == 0 || sign == std::string_view::npos) cursor_.refuse("key=value");
            scene_.form_factors.options.emplace_back(as_utf8(word.substr(0, sign)),
                                                     as_utf8(word.substr(sign + 1)));
        }
    }

    void format() {
        const std::string_view word = cursor_.word("3 or 3a");
        if (word != "3" && word != "3a" && word != "3A") cursor_.refuse("3 or 3a");
    }

    void vertex() {
        const std::uint32_t id = cursor_.count("the number of a vertex, from 1", 1, most_id);
        const Place place = cursor_.place();
        Vec3 p;
        for (std::size_t i = 0; i < 3; ++i)
            p[i] = cursor_.number("a coordinate, at most 1e9", -limits::coordinate,
                                  limits::coordinate);
        if (!vertices_.emplace(id, p).second)
            throw Error(place, fmt::format("there is already a vertex {}", id));
    }

    void surface(FormFactorRole role) {
        Entry entry;
        entry.role = role;
        entry.id = cursor_.count("the number of a surface, from 1", 1, most_id);
        entry.place = cursor_.place();
        if (!by_id_.emplace(entry.id, entries_.size()).second)
            throw Error(entry.place, fmt::format("there is already a surface {}", entry.id));
        for (int i = 0; i < 4; ++i) {
            const std::uint32_t v =
                cursor_.count("the number of a vertex", i == 3 ? 0 : 1, most_id);
            if (v == 0) break;
            const auto found = vertices_.find(v);
            if (found == vertices_.end())
                throw Error(cursor_.place(), fmt::format("there is no vertex {} before", v));
            entry.corners.push_back({found->second, {}});
        }
        entry.base = cursor_.count("the number of the base, 0 for none", 0, most_id);
        entry.combine =
            cursor_.count("the number of the surface to combine with, 0 for none", 0, most_id);
        entry.emissivity = cursor_.number("an emissivity, 0 to 1", 0, 1);
        if (!cursor_.line_ended()) entry.name = as_utf8(cursor_.word(""));
        if (entry.name.empty() || entry.name[0] == '!')
            entry.name = fmt::format("surface {}", entry.id);
        entries_.push_back(std::move(entry));
    }

    std::optional<std::uint32_t> index_of(std::uint32_t id, const Entry& from,
                                          const char* what) const {
        if (id == 0) return std::nullopt;
        const auto found = by_id_.find(id);
        if (found == by_id_.end())
            throw Error(from.place, fmt::format("surface {} has the {} {}, which there is not",
                                                from.id, what, id));
        if (entries_[found->second].id == from.id)
            throw Error(from.place, fmt::format("surface {} is its own {}", from.id, what));
        return static_cast<std::uint32_t>(found->second);
    }

    std::uint32_t material(const Entry& entry) {
        const bool black = entry.role == FormFactorRole::obstruction;
        const double rho = black ? 0 : 1 - entry.emissivity;
        const auto [found, fresh] = materials_.try_emplace({rho, black}, 0U);
        if (fresh) {
            Material made;
            made.name =
                black ? std::string("obstruction") : fmt::format("emissivity {:g}", 1 - rho);
            made.reflectance.assign(3, rho);
            made.exitance.assign(3, 0.0);
            made.place = entry.place;
            found->second = scene_.add_material(std::move(made));
        }
        return found->second;
    }

    // Surfaces first, so that their numbers are those of the entries.
    void build() {
        std::vector<std::vector<std::vector<Corner>>> loops(entries_.size());
        for (std::size_t i = 0; i < entries_.size(); ++i) loops[i].push_back(entries_[i].corners);
        for (std::size_t i = 0; i < entries_.size(); ++i) {
            const Entry& entry = entries_[i];
            FormFactorSurface made;
            made.surface = scene_.add_surface(entry.name, material(entry));
            scene_.surfaces[made.surface].place = entry.place;
            made.role = entry.role;
            made.base = index_of(entry.base, entry, "base");
            made.combine = index_of(entry.combine, entry, "surface to combine with");
            made.emissivity = entry.emissivity;
            if (made.base) loops[*made.base].push_back(entry.corners);
            if (entry.role == FormFactorRole::mask)
                warnings_.add("mask", entry.place,
                              "a mask is taken as a hole in its base: there is nothing there");
            scene_.form_factors.surfaces.push_back(made);
        }
        for (std::size_t i = 0; i < entries_.size(); ++i) {
            const Entry& entry = entries_[i];
            if (entry.role == FormFactorRole::mask || entry.role == FormFactorRole::null) continue;
            add(entry, loops[i], static_cast<std::uint32_t>(i));
        }
    }

    static double area_of(const std::vector<Corner>& corners) {
        std::vector<Vec3> points;
        for (const Corner& corner : corners) points.push_back(corner.point);
        return area(points);
    }

    void add(const Entry& entry, const std::vector<std::vector<Corner>>& loops,
             std::uint32_t surface) {
        const std::size_t first = scene_.polygons.size();
        collector_.use_surface(surface);
        if (loops.size() == 1) {
            collector_.add_face(loops[0], {}, entry.place);
            return;
        }
        collector_.add_face_with_holes(loops, {}, entry.place);
        const double whole = area_of(loops[0]);
        double left = whole;
        for (std::size_t h = 1; h < loops.size(); ++h) left -= area_of(loops[h]);
        double made = 0;
        for (std::size_t p = first; p < scene_.polygons.size(); ++p)
            made += scene_.area(scene_.polygons[p]);
        if (std::abs(made - left) > area_share * whole)
            warnings_.add("holes", entry.place,
                          fmt::format("the subsurfaces of {} do not lie apart inside it; it has "
                                      "{:g} m² instead of {:g} m²",
                                      in_quotes(entry.name), made, left));
    }

    TextCursor cursor_;
    Scene scene_;
    ReadWarnings warnings_;
    ReadBudget budget_;
    PolygonCollector collector_;
    std::unordered_map<std::uint32_t, Vec3> vertices_;
    std::unordered_map<std::uint32_t, std::size_t> by_id_;
    std::map<std::pair<double, bool>, std::uint32_t> materials_;
    std::vector<Entry> entries_;
};

}  // namespace

Scene parse_view3d(const std::filesystem::path& path, std::string_view text,
                   const ReadOptions& options) {
    return View3dReader(path, text, options).read();
}

}  // namespace exitance
