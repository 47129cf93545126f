// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/project_keys.h"

#include <algorithm>

namespace exitance {

namespace {

// What sun and sky have in common.
std::vector<ProjectKey> with_colour_and_level(std::vector<ProjectKey> keys) {
    using enum ProjectKey::Kind;
    keys.insert(keys.end(), {{"color", spectrum, "only its proportions count"},
                             {"color_temperature", number, "1000 to 25000 K"},
                             {"multiplier", number, "factor"},
                             {"dimming", number, "0 to 1"},
                             {"maintenance", number, "0 to 1"},
                             {"group", text, "light group; default: the name"}});
    return keys;
}

}  // namespace

const std::vector<ProjectTable>& project_tables() {
    using enum ProjectKey::Kind;
    static const std::vector<ProjectTable> tables{
        {"",
         false,
         "A lighting project",
         {{"title", text, "default: the file's stem"},
          {"quantity",
           text,
           "what light is measured in",
           false,
           {"photometric", "radiometric", "unitless"}}}},
        {"geometry",
         true,
         "A file with geometry",
         {{"file", text, ".glb, .gltf, .mgf, .rad, .geom or another project", true},
          {"unit", unit, "m, cm, mm, in, ft or a number of metres"},
          {"up", text, "which of its axes points up", false, {"x", "y", "z"}},
          {"scale", number, "factor"},
          {"rotate", turn, "[x, y, z, degrees] about an axis"},
          {"translate", vector, "metres"}}},
        {"material",
         true,
         "Changes materials, or makes one",
         {{"match", text, "pattern of names to change"},
          {"name", text, "of a new material"},
          {"reflectance", spectrum, "0 to 1"},
          {"exitance", spectrum, "emitted, per area"},
          {"luminance", spectrum, "instead of exitance [cd/m²]"},
          {"group", text, "light group of what it emits"},
          {"two_sided", flag, "reflects and emits from both sides"},
          {"transmittance", spectrum, "0 to 1, straight through: glass"}}},
        {"polygon",
         true,
         "Geometry in place",
         {{"corners", points, "three or four, counter-clockwise seen from the front", true},
          {"material", text, "by name", true},
          {"patches", count, "into how many it is divided"},
          {"name", text, "of its surface"}}},
        {"luminaire",
         true,
         "A lamp, or rows of them",
         {{"name", text, "of the lamp", true},
          {"shape",
           text,
           "of a lamp without a file",
           false,
           {"rectangle", "disc", "sphere", "point", "spot"}},
          {"file", text, ".ies or .ldt"},
          {"position", vector, "the middle of what shines, or of the array", true},
          {"aim", vector, "the direction it shines along"},
          {"target", vector, "a point it is turned to"},
          {"up", vector, "along its height"},
          {"rotation", number, "about the vertical, degrees"},
          {"width", number, "metres"},
          {"height", number, "metres"},
          {"radius", number, "metres"},
          {"beam", number, "full angle at half of the largest intensity, degrees"},
          {"field", number, "full angle at a tenth, degrees"},
          {"lumens", number, "flux"},
          {"watts", number, "flux"},
          {"exitance", spectrum, "instead of flux"},
          {"candela", number, "instead of flux"},
          {"lamp_lumens", number, "other lamps than those measured"},
          {"lamp_set", count, "of an EULUMDAT file"},
          {"multiplier", number, "of the flux"},
          {"dimming", number, "0 to 1"},
          {"color", spectrum, "only its proportions count"},
          {"maintenance", number, "0 to 1"},
          {"color_temperature", number, "1000 to 25000 K"},
          {"group", text, "light group; default: its name"},
          {"columns", count, "along x"},
          {"rows", count, "along z"},
          {"spacing", pair, "metres"},
          {"array_rotation", number, "degrees"},
          {"housing", flag, "a grey box of the luminaire's size"}}},
        {"site",
         false,
         "Place and time",
         {{"latitude", number, "degrees, north positive", true},
          {"longitude", number, "degrees, east positive", true},
          {"time", time, "date and time of day", true},
          {"time_zone", number, "hours ahead of universal time"},
          {"north", number, "turns north from −z, degrees, counter-clockwise seen from above"}}},
        {"sky", false, "Light of the sky",
         with_colour_and_level(
             {{"model",
               text,
               "distribution of the luminance",
               true,
               {"overcast", "clear", "cie", "perez", "uniform", "map"}},
              {"type", count, "of the CIE standard general skies, 1 to 15"},
              {"zenith_luminance", number, "cd/m² or W/(m² sr)"},
              {"horizontal", number, "illuminance of the open ground"},
              {"direct_normal", number, "W/m², of perez"},
              {"diffuse_horizontal", number, "W/m², of perez"},
              {"ground_reflectance", number, "of the plane below the horizon, 0 to 1"},
              {"file", text, "equirectangular .hdr or .exr"},
              {"rotation", number, "of the map, degrees"},
              {"scale", number, "of the map"},
              {"name", text, "default: sky"}})},
        {"sun", false, "Light of the sun",
         with_colour_and_level({{"altitude", number, "degrees above the horizon"},
                                {"azimuth", number, "degrees from north over east"},
                                {"direction", vector, "towards it"},
                                {"normal", number, "illuminance across its rays"},
                                {"diameter", number, "degrees"},
                                {"name", text, "default: sun"}})},
        {"scenes",
         true,
         "Factors of light groups under a name",
         {{"name", text, "of the scene", true}},
         true},
        {"camera",
         true,
         "Who looks",
         {{"name", text, "of the camera"},
          {"eye", vector, "where it stands", true},
          {"look_at", vector, "the point it looks at", true},
          {"up", vector, "default: y"},
          {"fov", number, "full vertical angle, degrees"},
          {"aspect", number, "width / height"}}},
        {"grid",
         true,
         "A grid of sensors",
         {{"name", text, "of the grid"},
          {"origin", vector, "a corner", true},
          {"u", vector, "edge along the columns", true},
          {"v", vector, "edge along the rows", true},
          {"columns", count, "along u"},
          {"rows", count, "along v"},
          {"spacing", number, "instead of columns and rows, metres"},
          {"margin", number, "left free along all edges, metres"},
          {"normal", vector, "default: u × v"}}},
        {"solve", false, "Options of exitance solve, by their names without dashes", {}, true},
    };
    return tables;
}

std::vector<std::string> project_keys(const std::string& table) {
    std::vector<std::string> out;
    for (const ProjectTable& candidate : project_tables()) {
        if (candidate.name == table)
            for (const ProjectKey& key : candidate.keys) out.push_back(key.name);
        if (table.empty() && !candidate.name.empty()) out.push_back(candidate.name);
    }
    return out;
}

}  // namespace exitance
