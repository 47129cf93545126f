// SPDX-License-Identifier: Apache-2.0
// All that emits from within a scene, in a tree by place: where many lamps matter little each, one
// of a branch can look for what is in the way of all of them (after lightcuts, Walter et al. 2005;
// but what lamps would send with nothing in the way is exact here).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exitance/solve/radiosity.h"

namespace exitance {

/// The faces that emit, brightest first.
std::vector<FaceId> emitters_of(const Radiosity& radiosity);

/// A polygon or a luminaire that emits.
struct Lamp {
    FaceId face{};                               ///< if the polygon is all of one
    std::optional<Source> polygon{};             ///< as seen from its front
    const LuminaireSource* luminaire = nullptr;  ///< if it is no polygon
    std::span<const float> emitted{};            ///< per column
    float level = 0;                             ///< luminance of `emitted`
    std::uint32_t number = 0;                    ///< decorrelates the samples
};

class Lamps {
  public:
    /// Of `faces` and all luminaires of the scene, which outlives this.
    Lamps(const Radiosity& radiosity, std::span<const FaceId> faces);
    explicit Lamps(const Radiosity& radiosity) : Lamps(radiosity, emitters_of(radiosity)) {}
    /// A lamp and where it is. Lamps of different groups share nothing.
    struct Placed {
        Lamp lamp;
        Vec3 place;
        std::size_t group = 0;
    };
    explicit Lamps(std::vector<Placed> lamps);

    /// Neighbours are neighbours in here, too.
    std::span<const Lamp> all() const { return lamps_; }
    std::size_t size() const { return lamps_.size(); }

    /// Branches of all(): [begin, end). A parent's left child follows it, the right one is at
    /// `right`, 0 for a single lamp. Branches hold lamps of one light group.
    struct Branch {
        std::uint32_t begin, end, right = 0;
    };
    std::span<const Branch> branches() const { return branches_; }
    /// Into branches(), the largest that there are: one per light group.
    std::span<const std::uint32_t> roots() const { return roots_; }

    std::size_t bytes() const;

  private:
    std::vector<Lamp> lamps_;
    std::vector<Branch> branches_;
    std::vector<std::uint32_t> roots_;
};

}  // namespace exitance
