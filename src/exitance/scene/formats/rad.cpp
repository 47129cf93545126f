// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/rad.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <numbers>
#include <unordered_map>

#include "exitance/scene/closed_bodies.h"
#include "exitance/scene/formats/include_files.h"
#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/polygon_collector.h"
#include "exitance/scene/formats/rad_command.h"
#include "exitance/scene/formats/rad_material.h"
#include "exitance/scene/formats/rad_tokens.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

// modifier type identifier, and its arguments.
struct Primitive {
    std::string modifier, type, name;
    std::vector<std::string> strings;
    std::vector<double> reals;
    Place place;  // of the line
};

class RadReader {
  public:
    RadReader(const std::filesystem::path& path, std::string text, const ReadOptions& options)
        : options_(options),
          files_(path, std::move(text), options),
          budget_(options),
          collector_(scene_, options, budget_, warnings_) {}

    Scene read() {
        RadTokens tokens(files_.current(), std::nullopt);
        read_all(tokens);
        for (const Material& material : scene_.materials)
            if (material.emits()) scene_.quantity = Quantity::radiometric;
        scene_.up = {0, 0, 1};
        warnings_.tell(scene_);
        close_bodies(scene_);
        return std::move(scene_);
    }

  private:
    // One xform that what is being read goes through.
    struct Moving {
        std::string name;
        bool invert = false;
        std::optional<std::string> modifier;
    };
    // What a modifier's name stands for.
    struct Modifier {
        std::optional<std::uint32_t> material;  // of the scene
        bool nothing = false;                   // surfaces of it are left out
    };
    struct Defined {
        std::string type;
        std::vector<double> reals;
        Modifier modifier;
    };

    void read_all(RadTokens& tokens) {
        while (true) {
            if (const auto command = tokens.command()) {
                run(*command, tokens);
            } else if (tokens.ended()) {
                return;
            } else {
                add(primitive(tokens));
            }
            budget_.spend_lines(1, [&] { return tokens.place(); });
        }
    }

    Primitive primitive(RadTokens& tokens) {
        Primitive out;
        out.modifier = tokens.word("a modifier");
        out.place = tokens.line_place();
        out.type = tokens.word("a type, such as 'polygon'");
        if (out.type != "alias" && !is_known(out.type)) {
            const std::vector<std::string> some{
                "polygon", "sphere", "cylinder", "cone",   "ring",      "tube",
                "cup",     "bubble", "plastic",  "metal",  "trans",     "glass",
                "light",   "glow",   "mirror",   "source", "dielectric"};
            tokens.refuse("a type of Radiance" + suggestion(out.type, some));
        }
        out.name = tokens.word("an identifier");
        if (out.type == "alias") {
            out.strings.emplace_back(tokens.word("the identifier that it stands for"));
            return out;
        }
        const auto count = [&](const char* expected) {
            const auto value = finite_number(tokens.word(expected));
            if (!value || *value < 0 || *value > 1e9 ||
                *value != static_cast<double>(static_cast<long>(*value)))
                tokens.refuse(expected);
            return static_cast<std::size_t>(*value);
        };
        // Lists grow with the words that are there.
        for (std::size_t n = count("a number of words, 0 or more"); n > 0; --n)
            out.strings.emplace_back(tokens.word("a word argument"));
        for (std::size_t n = count("a number of whole numbers, usually 0"); n > 0; --n)
            tokens.word("a whole number");
        const std::size_t reals = count("a number of real arguments, 0 or more");
        if (out.type == "polygon" && reals > 3 * options_.max_corners)
            throw Error(tokens.place(),
                        fmt::format("found a polygon of {} corners, expected at most {}; "
                                    "--max-corners raises the limit",
                                    reals / 3, options_.max_corners));
        for (std::size_t n = reals; n > 0; --n) {
            const auto value = finite_number(tokens.word("a real argument"));
            if (!value || std::abs(*value) > 1e30) tokens.refuse("a number");
            out.reals.push_back(*value);
        }
        return out;
    }

    static bool is_surface(std::string_view type) {
        static constexpr std::array<std::string_view, 11> types{
            "polygon", "sphere", "bubble", "cone",     "cup", "cylinder",
            "tube",    "ring",   "source", "instance", "mesh"};
        return std::find(types.begin(), types.end(), type) != types.end();
    }
    static bool is_known(std::string_view type) {
        return is_surface(type) || is_rad_material(type) || is_rad_pattern(type);
    }

    void add(const Primitive& p) {
        if (p.type == "alias")
            modifiers_[p.name] = modifier(p.strings[0], p.place);
        else if (is_rad_pattern(p.type))
            add_pattern(p);
        else if (is_rad_material(p.type))
            add_material(p);
        else
            add_surface(p);
    }

    // A pattern does nothing to the material before it; a mixture is its first part.
    void add_pattern(const Primitive& p) {
        warnings_.add("pattern " + p.type, p.place,
                      fmt::format("{} {} is not applied", p.type, in_quotes(p.name)));
        const bool mixture = p.type.rfind("mix", 0) == 0;
        if (mixture && p.strings.empty())
            throw Error(p.place, fmt::format("found no word arguments of {} {}, expected the names "
                                             "of two modifiers",
                                             p.type, in_quotes(p.name)));
        modifiers_[p.name] = modifier(mixture ? p.strings[0] : p.modifier, p.place);
    }

    void add_material(const Primitive& p) {
        Modifier& entry = modifiers_[p.name];
        entry = {};
        // Files that are read again, as in arrays, define the same again.
        std::vector<Defined>& before = defined_[p.name];
        for (const Defined& other : before)
            if (other.type == p.type && other.reals == p.reals) {
                entry = other.modifier;
                return;
            }
        Material material = rad_material(p.name, p.type, p.reals, p.place, warnings_);
        if (!before.empty()) material.name += fmt::format(" ({})", before.size() + 1);
        if (p.type == "antimatter" || p.type == "mist")
            entry.nothing = true;
        else
            entry.material = scene_.add_material(std::move(material));
        before.push_back({p.type, p.reals, entry});
    }

    Modifier modifier(const std::string& name, const Place& place) {
        if (name == "void") return {};
        const auto found = modifiers_.find(name);
        if (found != modifiers_.end()) return found->second;
        throw Error(place, fmt::format("there is no modifier {}", in_quotes(name)));
    }

    std::uint32_t black(const Place& place) {
        warnings_.add("void", place, "a surface without material is black");
        if (!black_) {
            Material material;
            material.name = "void";
            material.reflectance = material.exitance = {0, 0, 0};
            material.two_sided = true;
            material.place = place;
            black_ = scene_.add_material(std::move(material));
        }
        return *black_;
    }

    void add_surface(const Primitive& p) {
        std::string name = p.modifier;
        for (const Moving& moving : movings_)  // the outermost xform has the last word
            if (moving.modifier) {
                name = *moving.modifier;
                break;
            }
        const Modifier of = modifier(name, p.place);
        if (p.type == "instance" || p.type == "mesh") {
            warnings_.add(p.type, p.place,
                          fmt::format("the {} {} is in a compiled file and not read", p.type,
                                      in_quotes(p.name)));
            return;
        }
        if (p.type == "source") return source(p, of);
        if (of.nothing) {
            warnings_.add("nothing", p.place,
                          fmt::format("{} {} is no surface (antimatter or mist) and left out",
                                      p.type, in_quotes(p.name)));
            return;
        }
        collector_.start_surface(object_name(p.name), of.material ? *of.material : black(p.place),
                                 p.place);
        if (p.type == "polygon")
            polygon(p);
        else
            curved(p);
    }

    // Identifiers of generators end in a number per polygon: "box.3" belongs to "box".
    std::string object_name(const std::string& id) const {
        std::string out;
        for (const Moving& moving : movings_)
            if (!moving.name.empty()) out += moving.name + "/";
        const std::size_t dot = id.rfind('.');
        const bool numbered = dot != std::string::npos && dot > 0 && dot + 1 < id.size() &&
                              id.find_first_not_of("0123456789", dot + 1) == std::string::npos;
        return as_utf8(out + (numbered ? id.substr(0, dot) : id));
    }

    void expect_reals(const Primitive& p, std::size_t count) const {
        if (p.reals.size() != count)
            throw Error(p.place, fmt::format("found {} real arguments of {} {}, expected {}",
                                             p.reals.size(), p.type, in_quotes(p.name), count));
        for (const double value : p.reals)
            if (std::abs(value) > limits::coordinate)
                throw Error(p.place,
                            fmt::format("found {:g} in {} {}, expected at most {:g}", value, p.type,
                                        in_quotes(p.name), limits::coordinate));
    }
    static Vec3 point(const Primitive& p, std::size_t first) {
        return {p.reals[first], p.reals[first + 1], p.reals[first + 2]};
    }

    bool inverted() const {
        bool out = false;
        for (const Moving& moving : movings_) out ^= moving.invert;
        return out;
    }

    // A disc of uniform radiance at infinity: E = π L sin²(θ/2) across its axis.
    void source(const Primitive& p, const Modifier& of) {
        expect_reals(p, 4);
        DistantLight light;
        light.name = object_name(p.name);
        light.place = p.place;
        light.direction = normalized(placing_.vector(point(p, 0)));
        light.diameter = std::abs(p.reals[3]) * std::numbers::pi / 180;
        if (!is_finite(light.direction) || light.direction == Vec3{})
            throw Error(p.place, fmt::format("found no direction of source {}, expected one that "
                                             "is not zero",
                                             in_quotes(p.name)));
        if (light.diameter > std::numbers::pi / 2) {
            warnings_.add("source " + p.name, p.place,
                          fmt::format("source {} is wider than 90 degrees (a sky) and not read; "
                                      "[sky] of a project makes one",
                                      in_quotes(p.name)));
            return;
        }
        if (!of.material || !scene_.materials[*of.material].emits()) return;
        light.colour = scene_.materials[*of.material].exitance;
        const double level = luminance(light.colour);
        for (double& band : light.colour) band /= level;
        const double sine = std::sin(light.diameter / 2);
        light.irradiance = level * sine * sine;
        if (light.irradiance > 0) scene_.distant.push_back(std::move(light));
    }

    void polygon(const Primitive& p) {
        if (p.reals.size() < 9 || p.reals.size() % 3 != 0)
            throw Error(p.place,
                        fmt::format("found {} real arguments of polygon {}, expected three "
                                    "for each of three corners or more",
                                    p.reals.size(), in_quotes(p.name)));
        expect_reals(p, p.reals.size());
        std::vector<Corner> corners;
        for (std::size_t i = 0; i < p.reals.size(); i += 3) corners.push_back({point(p, i), {}});
        if (inverted()) std::reverse(corners.begin(), corners.end());
        collector_.add_face(corners, placing_, p.place);
    }

    void curved(const Primitive& p) {
        const std::uint32_t n = collector_.facets_per_turn();
        const std::string& type = p.type;
        const bool sphere = type == "sphere" || type == "bubble";
        const bool conical = type == "cone" || type == "cup";
        expect_reals(p, sphere ? 4 : type == "ring" || conical ? 8 : 7);
        bool inward = type == "bubble" || type == "cup" || type == "tube";
        const auto radius = [&](std::size_t i) {
            if (p.reals[i] < 0 && !sphere)
                throw Error(p.place, fmt::format("found the radius {:g} of {} {}, expected 0 or "
                                                 "more",
                                                 p.reals[i], type, in_quotes(p.name)));
            inward ^= p.reals[i] < 0;
            return std::abs(p.reals[i]);
        };
        budget_.spend_polygons(sphere ? sphere_facet_count(n) : n, [&] { return p.place; });
        Facets facets;
        if (sphere) {
            const double r = radius(3);
            if (r > 0) facets = sphere_facets(point(p, 0), r, n);
        } else if (type == "ring") {
            const double r0 = radius(6), r1 = radius(7);
            const Vec3 normal = normalized(point(p, 3));
            if (normal != Vec3{} && r0 != r1)
                facets = ring_facets(point(p, 0), normal, std::min(r0, r1), std::max(r0, r1), n);
        } else {
            const Vec3 from = point(p, 0), to = point(p, 3);
            const double r0 = radius(6), r1 = conical ? radius(7) : r0;
            if (length(to - from) > 0 && (r0 > 0 || r1 > 0))
                facets = frustum_facets(from, r0, to, r1, n);
        }
        if (facets.polygons.empty()) {
            warnings_.add("degenerate " + type, p.place,
                          fmt::format("{} {} without extent is left out", type, in_quotes(p.name)));
            return;
        }
        if (inward != inverted()) facets.turn_round();
        collector_.add_facets(facets, placing_, p.place);
    }

    // Commands.

    void run(const std::string& line, const RadTokens& tokens) {
        const Place place = tokens.place();
        const RadCommand command = understand_rad_command(line, place);
        for (const std::string& option : command.ignored)
            warnings_.add(option, tokens.line_place(),
                          option + " (rounded or bevelled edges) is left out: edges are sharp");
        through(command, command.xforms.size(), tokens.line_place(), place);
    }

    // Reads what goes through the first `count` xforms, the last of them outermost.
    void through(const RadCommand& command, std::size_t count, const Place& line,
                 const Place& place) {
        if (count == 0) {
            if (command.files.empty()) {
                RadTokens tokens(std::make_shared<SourceFile>(
                                     SourceFile{files_.current()->path, command.generated}),
                                 line);
                read_all(tokens);
            }
            for (const std::string& name : command.files) {
                RadTokens tokens(files_.enter(name, place), std::nullopt);
                read_all(tokens);
                files_.leave();
            }
            return;
        }
        const RadXform& xform = command.xforms[count - 1];
        const std::uint64_t copies = xform.arguments.copies();
        const Transform outer = placing_;
        const std::uint64_t repetitions = repetitions_;
        constexpr std::uint64_t countless = std::uint64_t{1} << 62;
        const bool first_of_all = repetitions > 0;
        movings_.push_back({xform.name, xform.invert, xform.modifier});
        for (std::uint64_t i = 0; i < copies; ++i) {
            // Limits are checked for all copies on the first.
            repetitions_ = !first_of_all || i > 0             ? 0
                           : copies > countless / repetitions ? countless
                                                              : repetitions * copies;
            budget_.expect_repetitions(std::max<std::uint64_t>(1, repetitions_));
            budget_.spend_lines(0, [&] { return place; });
            placing_ = outer.after(xform.arguments.copy(i));
            if (xform.arguments.is_array()) {
                std::string indices;
                for (const std::uint64_t k : xform.arguments.indices(i))
                    indices += (indices.empty() ? "" : ",") + std::to_string(k);
                movings_.back().name = xform.name + "[" + indices + "]";
            }
            through(command, count - 1, line, place);
        }
        movings_.pop_back();
        placing_ = outer;
        repetitions_ = repetitions;
        budget_.expect_repetitions(std::max<std::uint64_t>(1, repetitions_));
    }

    const ReadOptions& options_;
    IncludeFiles files_;
    Scene scene_;
    ReadWarnings warnings_;
    ReadBudget budget_;
    PolygonCollector collector_;
    std::unordered_map<std::string, Modifier> modifiers_;
    std::unordered_map<std::string, std::vector<Defined>> defined_;
    std::optional<std::uint32_t> black_;
    std::vector<Moving> movings_;
    Transform placing_;
    std::uint64_t repetitions_ = 1;  // of what is read now; 0 = not the first copy of all
};

}  // namespace

Scene parse_rad(const std::filesystem::path& path, std::string text, const ReadOptions& options) {
    return RadReader(path, std::move(text), options).read();
}

}  // namespace exitance
