// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/general_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "exitance/scene/closed_bodies.h"
#include "exitance/scene/formats/assimp_import.h"
#include "exitance/scene/formats/contained_call.h"
#include "exitance/scene/formats/imported_lights.h"
#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/polygon_collector.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

constexpr double pi = std::numbers::pi;
// Reflectance of what the file gives no material, and of the textures that are not read.
constexpr double unknown_reflectance = 0.5;

struct Kind {
    const char *extension, *name;
};
constexpr std::array<Kind, 7> kinds{{{".obj", "OBJ"},
                                     {".ply", "PLY"},
                                     {".stl", "STL"},
                                     {".fbx", "FBX"},
                                     {".dae", "Collada"},
                                     {".3ds", "3DS"},
                                     {".ifc", "IFC"}}};

const Kind* kind_of(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    const auto* found = std::find_if(kinds.begin(), kinds.end(),
                                     [&](const Kind& k) { return k.extension == extension; });
    return found == kinds.end() ? nullptr : found;
}

// What the importers say of files in which nothing is wrong, or what is told already.
bool is_chatter(std::string_view message) {
    static constexpr std::array<std::string_view, 4> known{
        "OBJ: No object detected", "OBJ: Unable to locate", "No hierarchy information",
        "FBX: no material assigned"};
    return std::any_of(known.begin(), known.end(),
                       [&](std::string_view start) { return message.starts_with(start); });
}

// The text between `begin` and the next `end` after it, at its first place in `bytes`.
std::string_view between(std::string_view bytes, std::string_view begin, std::string_view end) {
    const std::size_t at = bytes.find(begin);
    if (at == std::string_view::npos) return {};
    bytes.remove_prefix(at + begin.size());
    return bytes.substr(0, std::min(bytes.find(end), bytes.size()));
}

std::string unit_name(double metres) {
    struct Named {
        double metres;
        const char* name;
    };
    for (const Named& unit : {Named{1, "metres"},
                              {0.01, "centimetres"},
                              {0.001, "millimetres"},
                              {0.0254, "inches"},
                              {0.3048, "feet"}})
        if (std::abs(unit.metres - metres) < 1e-6 * metres) return unit.name;
    return fmt::format("{:.9g} m", metres);
}

// Assimp skips lines of numbers without a digit before the point, and with them the vertices.
std::string with_leading_zeros(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto is_digit = [&](std::size_t k) {
            return k < text.size() && text[k] >= '0' && text[k] <= '9';
        };
        const char before = i > 0 ? text[i - 1] : '\n';
        const bool starts = before == ' ' || before == '\t' || before == '-' || before == '+';
        if (text[i] == '.' && starts && is_digit(i + 1)) out += '0';
        out += text[i];
    }
    return out;
}

class GeneralGeometry {
  public:
    GeneralGeometry(const std::filesystem::path& path, const Kind& kind, const ImportedScene& from,
                    const ReadOptions& options)
        : place_{path.string(), 0, 0},
          kind_(kind),
          from_(from),
          budget_(options),
          collector_(scene_, options, budget_, warnings_) {
        scene_.title = as_utf8(path.stem().string());
    }

    Scene read(std::string_view bytes) {
        for (const std::string& name : from_.missing)
            warn("missing", fmt::format("there is no file {}", in_quotes(name)));
        for (const std::string& text : from_.warnings)
            if (!is_chatter(text)) warn(text, as_utf8(text));
        root_ = root(bytes);
        material_index_.assign(from_.materials.size(), std::nullopt);
        for (std::size_t i = 0; i < from_.nodes.size(); ++i) read_node(i);
        for (const ImportedCamera& camera : from_.cameras) read_camera(camera);
        for (const ImportedLight& light : from_.lights)
            add_imported_light(scene_, light, placing_of(light.name), place_, warnings_);
        if (scene_.polygons.empty()) warn("empty", "there are no polygons in the file");
        warnings_.tell(scene_);
        close_bodies(scene_);
        return std::move(scene_);
    }

  private:
    void warn(const std::string& kind, const std::string& what) {
        warnings_.add(kind, place_, what);
    }
    [[noreturn]] void refuse(const std::string& what) const {
        throw Error(place_, fmt::format("cannot be read as {}: {}", kind_.name, what));
    }

    // Metres, y up where the file says what is up; and a note of what was taken for what.
    Transform root(std::string_view bytes) {
        const std::string_view kind = kind_.extension;
        if (kind == ".fbx") return fbx_root();
        std::string text;
        if (kind == ".dae") {  // turned and scaled by the importer
            const std::string_view unit = between(bytes, "<unit", ">");
            const auto metres = finite_number(between(unit, "meter=\"", "\""));
            const std::string_view up = between(bytes, "<up_axis>", "</up_axis>");
            text = fmt::format(
                "units: {}; {} up, {}",
                metres ? unit_name(*metres) + ", from the file" : "metres, as nothing else is said",
                up.starts_with("Z")   ? "Z"
                : up.starts_with("X") ? "X"
                                      : "Y",
                up.empty() ? "as nothing else is said" : "from the file");
        } else if (kind == ".ifc") {
            text = "units: from the file; Z up, turned to Y up";
        } else if (kind == ".3ds") {
            text = "units: metres, as the format has none; Z up, turned to Y up";
        } else {
            text = "units: metres, and axes as they are: the format has neither";
        }
        scene_.notes.push_back({place_, text});
        return {};
    }

    Transform fbx_root() {
        const double metres = from_.unit.value_or(0.01);
        if (!(metres > 0 && metres < 1e6)) refuse(fmt::format("found a unit of {} m", metres));
        const int up = from_.up_axis.value_or(1), sign = from_.up_sign.value_or(1);
        if (up < 0 || up > 2) refuse(fmt::format("found the up axis {}, expected 0, 1 or 2", up));
        scene_.notes.push_back(
            {place_, fmt::format("units: {}, {}; {}{} up, {}", unit_name(metres),
                                 from_.unit ? "from the file" : "as nothing else is said",
                                 sign < 0 ? "-" : "", "XYZ"[up],
                                 from_.up_axis ? "from the file" : "as nothing else is said")});
        // The shortest rotation that brings the file's up to y.
        Transform turn;
        if (up == 1 && sign < 0) turn = {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {}};
        if (up == 2)
            turn = sign > 0 ? Transform{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {}}
                            : Transform{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {}};
        if (up == 0)
            turn = sign > 0 ? Transform{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, {}}
                            : Transform{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}, {}};
        return turn.after(Transform::scale(metres));
    }

    std::uint32_t material(std::uint32_t index) {
        if (index >= from_.materials.size())
            refuse(fmt::format("a mesh has the material {} of {}", index, from_.materials.size()));
        if (material_index_[index]) return *material_index_[index];
        const ImportedMaterial& from = from_.materials[index];
        Material to;
        to.name = as_utf8(from.name);
        to.place = place_;
        to.reflectance.assign(from.diffuse.begin(), from.diffuse.end());
        to.exitance.assign(from.emissive.begin(), from.emissive.end());
        // PLY has no materials; an unnamed one is the importer's own.
        const bool none = from.name == "DefaultMaterial" || from.name.empty();
        if (none || !from.diffuse_known) {
            if (none) to.name = "no material";
            to.reflectance.assign(3, unknown_reflectance);
            warn("no material", fmt::format("there is geometry without a material; its reflectance "
                                            "is taken as {}",
                                            unknown_reflectance));
        } else if (from.diffuse_texture) {
            for (double& rho : to.reflectance) rho *= unknown_reflectance;
            warn("texture", fmt::format("the texture of {} is not read; its reflectance is taken "
                                        "as {} of its colour",
                                        in_quotes(to.name), unknown_reflectance));
        }
        if (to.name.empty()) to.name = fmt::format("material {}", index + 1);
        if (from.emissive_texture)
            warn("emissive texture", fmt::format("the emissive texture of {} is not read; it emits "
                                                 "evenly",
                                                 in_quotes(to.name)));
        limit(to);
        see_through(from, to);
        // What emits does so from its front alone, or its flux would double.
        to.two_sided = from.two_sided || !to.emits();
        material_index_[index] = scene_.add_material(std::move(to));
        return *material_index_[index];
    }

    void limit(Material& to) {
        for (double& rho : to.reflectance) {
            if (rho >= 0 && rho <= 1) continue;
            if (!std::isfinite(rho)) refuse("a reflectance is not a finite number");
            warn("reflectance", fmt::format("the diffuse colour of {} is {:g} in a band; it is "
                                            "limited to 0 … 1",
                                            in_quotes(to.name), rho));
            rho = std::clamp(rho, 0.0, 1.0);
        }
        for (double& e : to.exitance) {
            if (e >= 0 && e <= limits::exitance) continue;
            refuse(fmt::format("found the exitance {:g} of {}, expected 0 to {:g}", e,
                               in_quotes(to.name), limits::exitance));
        }
    }

    // Opacity d: d of the light meets the surface, the rest goes straight through.
    void see_through(const ImportedMaterial& from, Material& to) {
        if (!(from.opacity < 1)) return;
        const double opacity = std::max(0.0, from.opacity);
        for (double& rho : to.reflectance) rho *= opacity;
        to.transmittance.assign(3, 1 - opacity);
        to.refractive_index = from.refractive_index;
        if (opacity == 0)
            warn("invisible", fmt::format("{} has the opacity 0: it lets all light through",
                                          in_quotes(to.name)));
    }

    // Placing and name of a node, "room/table", without the importer's root.
    struct Placed {
        Transform placing;
        std::string name;
    };

    void read_node(std::size_t index) {
        const ImportedNode& node = from_.nodes[index];
        Placed placed{root_.after(node.placing), ""};
        if (node.parent) {
            if (*node.parent >= index) refuse("a node is its own ancestor");
            const Placed& above = placed_[*node.parent];
            placed.placing = above.placing.after(node.placing);
            placed.name = above.name + (above.name.empty() || node.name.empty() ? "" : "/") +
                          as_utf8(node.name);
            if (placed.name.size() > 4096) placed.name.resize(4096);
        }
        placed_.push_back(placed);
        for (const std::uint32_t mesh : node.meshes) {
            if (mesh >= from_.meshes.size())
                refuse(fmt::format("a node has the mesh {} of {}", mesh, from_.meshes.size()));
            read_mesh(from_.meshes[mesh], placed);
        }
    }

    void read_mesh(const ImportedMesh& mesh, const Placed& placed) {
        const std::uint32_t made_of = material(mesh.material);
        const std::string& name = placed.name;
        collector_.start_surface(!name.empty()        ? name
                                 : !mesh.name.empty() ? as_utf8(mesh.name)
                                                      : scene_.materials[made_of].name,
                                 made_of, place_);
        const bool smooth = mesh.normals.size() == mesh.positions.size();
        std::size_t at = 0;
        std::vector<Corner> corners;
        for (const std::uint32_t count : mesh.face_corners) {
            if (count > mesh.corners.size() - at) refuse("a face has more corners than there are");
            corners.clear();
            for (std::uint32_t i = 0; i < count; ++i) {
                const std::uint32_t v = mesh.corners[at + i];
                if (v >= mesh.positions.size())
                    refuse(fmt::format("a face has the vertex {} of {}", v, mesh.positions.size()));
                const Vec3& p = mesh.positions[v];
                if (!is_finite(p)) refuse("a coordinate is not a finite number");
                Vec3 n = smooth ? mesh.normals[v] : Vec3{};
                if (!is_finite(n)) n = {};
                corners.push_back({p, n});
            }
            at += count;
            collector_.add_face(corners, placed.placing, place_);
        }
    }

    Transform placing_of(const std::string& name) const {
        for (std::size_t i = 0; i < from_.nodes.size(); ++i)
            if (from_.nodes[i].name == name) return placed_[i].placing;
        return root_;
    }

    void read_camera(const ImportedCamera& from) {
        const Transform placing = placing_of(from.name);
        const Vec3 view = normalized(placing.vector(from.view));
        const Vec3 up = normalized(placing.vector(from.up));
        if (!(from.fov_x > 0 && from.fov_x < pi) || !(length(cross(view, up)) > 1e-9) ||
            !is_finite(placing.point(from.position))) {
            warn("camera", "a camera that is not a perspective one is left out");
            return;
        }
        Camera to;
        to.name = from.name.empty() ? fmt::format("camera {}", scene_.cameras.size() + 1)
                                    : as_utf8(from.name);
        to.eye = placing.point(from.position);
        to.look_at = to.eye + view;
        to.up = up;
        double aspect = from.aspect;
        if (aspect > 1e-3 && aspect < 1e3) {
            to.aspect = aspect;
        } else {
            aspect = 4.0 / 3;
            scene_.notes.push_back({place_, fmt::format("camera {}: its angle is horizontal and "
                                                        "meant for a picture of 4:3, as nothing "
                                                        "else is said",
                                                        in_quotes(to.name))});
        }
        to.fov_y = 2 * std::atan(std::tan(from.fov_x / 2) / aspect) * 180 / pi;
        scene_.cameras.push_back(std::move(to));
    }

    Place place_;
    const Kind& kind_;
    const ImportedScene& from_;
    Scene scene_;
    ReadWarnings warnings_;
    ReadBudget budget_;
    PolygonCollector collector_;
    Transform root_;
    std::vector<std::optional<std::uint32_t>> material_index_;
    std::vector<Placed> placed_;
};

// Memory and time that an honest file of this size needs are far below.
CallLimits limits_for(std::size_t bytes) {
    const std::uint64_t megabytes = bytes / (1024 * 1024);
    return {(std::uint64_t{1} << 30) + 200 * std::uint64_t{bytes}, 2 + 8 * megabytes};
}

}  // namespace

bool is_general_geometry(const std::filesystem::path& path) {
    return kind_of(path) != nullptr;
}

Scene parse_general_geometry(const std::filesystem::path& path, const std::string& bytes,
                             const ReadOptions& options) {
    const Place place{path.string(), 0, 0};
    const Kind& kind = *kind_of(path);
    const auto refuse = [&](const std::string& why) {
        throw Error(place, fmt::format("cannot be read as {}: {}", kind.name, why));
    };
    // Archives in the place of XML would be unpacked. XML has no such control characters.
    if (std::string_view(kind.extension) == ".dae" && bytes.find("PK\x05\x06") != std::string::npos)
        refuse("it is an archive");
    // Assimp 5.2 looks for it for ever.
    if (std::string_view(kind.extension) == ".ply" && bytes.find("end_header") == std::string::npos)
        refuse("its header has no end_header");
    const bool obj = std::string_view(kind.extension) == ".obj";
    ImportedScene imported;
    try {
        imported = unpack(contained_call(
            [&] {
                return pack(assimp_import(path, kind.extension,
                                          obj ? with_leading_zeros(bytes) : bytes, options));
            },
            limits_for(bytes.size())));
    } catch (const CallFailed& failure) {
        refuse(as_utf8(failure.what()));
    } catch (const std::length_error& failure) {
        refuse(failure.what());
    }
    if (!imported.refused.empty()) throw Error(Fault::bad_input, imported.refused);
    return GeneralGeometry(path, kind, imported, options).read(bytes);
}

}  // namespace exitance
