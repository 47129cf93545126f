// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/read_options.h"

namespace exitance {

Options describe(ReadOptions& o) {
    return {
        {"strict", &o.strict, "warnings about the scene's files are errors"},
        {"tolerance", &o.tolerance,
         "how far a facet may lie inside the curved surface it stands for (MGF, Radiance), as a "
         "share of its radius",
         "", 1e-6, 0.5},
        {"max-include-depth", &o.max_include_depth, "files that are open one inside the other", "",
         1, 256},
        {"max-files", &o.max_files,
         "files that a scene may name, counted as often as they are read", "", 1, 1e9},
        {"max-file-size", &o.max_file_size, "largest file that is read", "MiB", 1e-6, 1e6},
        {"max-polygons", &o.max_polygons, "polygons of a scene", "", 1, 134217728},
        {"max-corners", &o.max_corners, "corners of one polygon (MGF, Radiance)", "", 3, 1e6},
        {"max-lines", &o.max_lines,
         "lines that are read, those of arrays and included files as often as they count (MGF, "
         "Radiance)",
         "", 1, 1e12},
        {"max-texture-pixels", &o.max_texture_pixels,
         "pixels of all textures of a glTF, and of an environment map", "", 1, 1e10},
        {"max-luminaires", &o.max_luminaires, "lamps of a project, those of arrays one by one", "",
         1, 1e8},
    };
}

}  // namespace exitance
