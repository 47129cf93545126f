// SPDX-License-Identifier: Apache-2.0
// What info says about a scene or a solution: facts gathered once, told in words or as JSON.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exitance/math/box.h"
#include "exitance/scene/scene.h"
#include "exitance/solution/solution.h"

namespace exitance::cli {

struct MaterialFacts {
    const Material* material = nullptr;
    double area = 0;  ///< of its polygons, one side [m²]
    std::uint32_t polygons = 0;
};

struct LampFacts {
    std::string name;
    double area = 0, flux = 0;  ///< of both sides where both emit [m², flux_unit]
    std::uint32_t surfaces = 0, luminaires = 0, distant = 0;
};

struct SkyAngles {
    double altitude = 0, azimuth = 0;  ///< above the horizon; from −z (or +y) over +x [degrees]
};
/// Where a unit vector points; nothing where neither y nor z is up.
std::optional<SkyAngles> sky_angles(const Vec3& direction, const Vec3& up);

/// One line: the name and the factors of the groups.
std::string scene_text(const LightScene& scene);

/// Refers to the scene it is given.
class SceneReport {
  public:
    SceneReport(const Scene& scene, std::vector<Problem> problems, std::filesystem::path file);

    std::string text() const;
    std::string json() const;

  private:
    std::string notes_text() const;
    std::string geometry_text() const;
    std::string materials_text() const;
    std::string light_text() const;
    std::string distant_text() const;
    std::string views_text() const;
    std::string problems_text() const;

    const Scene& scene_;
    std::vector<Problem> problems_;
    std::filesystem::path file_;
    std::vector<MaterialFacts> materials_;
    std::vector<LampFacts> groups_;  ///< as --groups file makes them
    double area_ = 0, flux_ = 0;
    std::uint32_t triangles_ = 0, quads_ = 0;
    Box bounds_;
};

class SolutionReport {
  public:
    SolutionReport(Solution solution, std::filesystem::path file);

    std::string text() const;
    std::string json() const;

  private:
    Solution solution_;
    std::filesystem::path file_;
    Box bounds_;
};

}  // namespace exitance::cli
