// SPDX-License-Identifier: Apache-2.0
// How much of a polygon points on flat surfaces see past everything that stands in a scene: exact
// where what stands between is a few convex obstacles, which is most of an ordinary room.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/math/box_tree.h"
#include "exitance/visibility/blocker.h"
#include "exitance/visibility/receivers.h"

namespace exitance {

/// All that stands in a scene, relative to its middle.
class Obstacles {
  public:
    /// `polygons`, relative to that middle, are planar and convex and block both ways.
    explicit Obstacles(std::span<const std::span<const Vec3>> polygons);

    std::span<const Blocker> blockers() const { return blockers_; }
    const BoxTree& tree() const { return tree_; }
    /// What is nearer than this touches [m].
    double slack() const { return slack_; }
    std::size_t bytes() const;

  private:
    std::vector<Blocker> blockers_;
    BoxTree tree_;
    double slack_ = 0;
};

/// Per receiver of a block.
struct ViewsOfSource {
    std::array<float, ReceiverBlock::capacity> visible;  ///< share of the unobstructed factor
    std::array<bool, ReceiverBlock::capacity> known;     ///< false: too much stands between
};

/// Looks at `source` from the receivers for which rays[i] is not 0, lifted off their surface by
/// `clearance`. Neighbours in the block that lie in one plane are looked at together, unless as
/// many rays as `rays` says cost less.
void view_source(const Obstacles& obstacles, const Source& source, const ReceiverBlock& receivers,
                 std::span<const std::uint8_t> rays, double clearance, ViewsOfSource& views);

}  // namespace exitance
