// SPDX-License-Identifier: Apache-2.0
// Lights of a glTF: KHR_lights_punctual and EXT_lights_ies become luminaires.
#pragma once

#include <map>

#include "exitance/math/transform.h"
#include "exitance/scene/formats/gltf_resources.h"
#include "exitance/scene/formats/json_text.h"
#include "exitance/scene/scene.h"

namespace tinygltf {
class Node;
}

namespace exitance {

class GltfLights {
  public:
    /// Adds to `scene`.
    GltfLights(Scene& scene, const GltfResources& resources, const JsonText& json);

    /// The lights that hang at node `index`, `name`, if any.
    void add(std::size_t index, const std::string& name, const Transform& world);

  private:
    void add_punctual(const JsonNode& light, const std::string& name, const Transform& world);
    void add_directional(const JsonNode& light, const std::string& name, const Transform& world);
    void add_ies(const JsonNode& placed, const std::string& name, const Transform& world);
    void place(Luminaire luminaire, const JsonNode& colour, double level, const Transform& world);

    Scene& scene_;
    const GltfResources& resources_;
    const JsonText& json_;
    std::map<std::size_t, std::shared_ptr<const Photometry>> photometry_;  ///< by light of the file
    std::shared_ptr<const Photometry> point_;
};

}  // namespace exitance
