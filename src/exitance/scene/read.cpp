// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/read.h"

#include "exitance/scene/formats/afit.h"
#include "exitance/scene/formats/source_text.h"
#include "exitance/scene/mend.h"

namespace exitance {

namespace {

// A display file beside a geometry file of the same stem says who looks.
Scene read_afit_with_display(const std::filesystem::path& path) {
    Scene scene = read_afit_geometry(path);
    std::filesystem::path display = path;
    display.replace_extension(".display");
    if (std::filesystem::exists(display))
        scene.cameras.push_back(camera_of(read_afit_display(display)));
    return scene;
}

}  // namespace

Scene read_scene(const std::filesystem::path& path) {
    Scene scene = read_afit_with_display(path);
    mend(scene);
    return scene;
}

}  // namespace exitance
