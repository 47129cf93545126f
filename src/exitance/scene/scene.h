// SPDX-License-Identifier: Apache-2.0
// What is there: polygons in metres, how they reflect, what they emit, who looks.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exitance/math/box.h"
#include "exitance/math/vector.h"
#include "exitance/run/error.h"
#include "exitance/scene/distant_light.h"
#include "exitance/scene/form_factor_setup.h"
#include "exitance/scene/luminaire.h"
#include "exitance/scene/spectrum.h"
#include "exitance/scene/texture.h"

namespace exitance {

/// What the emission of a scene, and with it every exitance and irradiance, is measured in.
enum class Quantity {
    unitless,     ///< no claim; printed without a unit
    radiometric,  ///< W/m²
    photometric   ///< lm/m² = lx
};

/// Unit of exitance: "W/m²", "lm/m²" or "".
std::string exitance_unit(Quantity quantity);
/// Unit of irradiance: "W/m²", "lx" or "".
std::string irradiance_unit(Quantity quantity);
/// Unit of flux: "W", "lm" or "".
std::string flux_unit(Quantity quantity);

/// How a surface reflects, transmits and emits; the same all over it but for patterns. Radiosity is
/// solved for `reflectance`; what is mirrored is left to whoever looks at the solution. In every
/// band reflectance, specular, diffuse transmittance and transmittance add up to at most 1.
struct Material {
    std::string name;
    Spectrum reflectance;                 ///< total diffuse reflectance per band, 0 … 1
    Spectrum exitance;                    ///< emitted exitance per band [exitance_unit]
    std::string group;                    ///< light group of the emission; "" = chosen by --groups
    bool two_sided = false;               ///< reflects (and emits) from both sides
    std::optional<int> reflectance_file;  ///< AFIT `material m`
    Place place;                          ///< where it was declared
    Spectrum specular{};                  ///< mirror-like reflectance per band; empty = none
    double roughness = 0;                 ///< of mirror-like reflection: RMS slope of its facets
    Spectrum diffuse_transmittance{};     ///< per band, spread over the other side; empty = none
    Spectrum transmittance{};             ///< per band, straight through (glass); empty = none
    std::optional<double> refractive_index{};  ///< of a solid body, where the file says
    Pattern reflectance_pattern{};  ///< over the surface; `reflectance` is its mean there
    Pattern exitance_pattern{};     ///< over the surface; `exitance` is its mean there

    bool emits() const;
    bool transmits() const;
    bool patterned() const { return reflectance_pattern || exitance_pattern; }
    /// Share of light that glass lets straight through; 0 for what blocks it. One number, weighted
    /// by luminance: rays do not carry colours.
    double clear_transmittance() const;
};

/// A named set of polygons of one material: a glTF primitive, an OBJ group, a luminaire.
struct Surface {
    std::string name;
    std::uint32_t material = 0;
    bool luminaire = false;  ///< made from a lamp of the project file, a light group of its own
    Place place{};           ///< where it was declared
};

/// Three or four corners, counter-clockwise seen from the front.
struct Polygon {
    static constexpr std::uint32_t none = 0xffffffffU;

    std::array<std::uint32_t, 4> corners{none, none, none, none};  ///< into Scene::points
    std::uint32_t surface = 0;
    std::uint32_t patches = 0;  ///< number of patches asked for by the file; 0 = by size
    std::uint32_t line = 0;     ///< of the surface's file that declares it; 0 = unknown

    std::uint32_t size() const { return corners[3] == none ? 3 : 4; }
    std::span<const std::uint32_t> indices() const { return {corners.data(), size()}; }
};

/// Where a point lies on the textures of its surface's material. Only triangles have patterns.
struct TextureCoordinates {
    TexturePoint reflectance, exitance;
    friend bool operator==(const TextureCoordinates&, const TextureCoordinates&) = default;
};

struct Camera {
    std::string name = "camera";
    Vec3 eye{0, 0, 1}, look_at{}, up{0, 1, 0};
    double fov_y = 45;               ///< full vertical angle [degrees]
    std::optional<double> aspect{};  ///< width / height, where the file says
    std::optional<double> near{}, far{};
};

/// Points origin + (i + ½)/columns · u + (j + ½)/rows · v, facing `normal`.
struct SensorGrid {
    std::string name = "grid";
    Vec3 origin, u, v, normal;
    std::uint32_t columns = 1, rows = 1;
};

/// Something found while reading or checking; never silently dropped.
struct Problem {
    Place place;
    std::string what;
};

/// `key = value` of a project's [solve] table, applied to the solve's options before the command
/// line.
struct Setting {
    std::string name, value;
    Place place;
};

/// Factors of light groups under a name, "morning"; groups that it does not name keep their own.
struct LightScene {
    std::string name;
    std::map<std::string, double> factors;
    Place place{};
};

struct Scene {
    std::string title;
    Quantity quantity = Quantity::unitless;
    std::vector<std::string> bands{"R", "G", "B"};
    Vec3 up{0, 1, 0};  ///< by the convention of the file's format

    std::vector<Vec3> points;   ///< [m]
    std::vector<Vec3> normals;  ///< parallel to `points`: unit shading normal, zero = geometric
    /// Of the first points, as far as any has some; see texture_coordinates_of().
    std::vector<TextureCoordinates> texture_coordinates;
    std::vector<Polygon> polygons;
    std::vector<Surface> surfaces;
    std::vector<Material> materials;
    std::vector<Luminaire> luminaires;  ///< lamps without geometry
    std::vector<DistantLight> distant;  ///< sun and sky
    std::vector<LightScene> light_scenes;
    std::vector<Camera> cameras;
    std::vector<SensorGrid> grids;
    FormFactorSetup form_factors;   ///< from a View3D file
    std::vector<Setting> settings;  ///< from [solve] of a project file
    std::vector<Problem> warnings;  ///< from the readers
    std::vector<Problem> notes;     ///< what the readers took for granted; nothing is wrong

    /// Corners of a polygon; only the first `size()` are meaningful.
    std::array<Vec3, 4> corners(const Polygon& polygon) const;
    double area(const Polygon& polygon) const;
    double area() const;  ///< of all polygons
    Vec3 normal(const Polygon& polygon) const;
    const Material& material(const Polygon& polygon) const {
        return materials[surfaces[polygon.surface].material];
    }
    Box bounds() const;
    /// A surface as messages call it: "'chair' (oak)", the material where it has another name.
    std::string label(std::uint32_t surface) const;

    std::uint32_t add_point(const Vec3& point, const Vec3& normal = {});
    void set_texture_coordinates(std::uint32_t point, const TextureCoordinates& coordinates);
    TextureCoordinates texture_coordinates_of(std::uint32_t point) const {
        return point < texture_coordinates.size() ? texture_coordinates[point]
                                                  : TextureCoordinates{};
    }
    std::uint32_t add_material(Material material);
    std::uint32_t add_surface(std::string name, std::uint32_t material);
};

}  // namespace exitance
