// SPDX-License-Identifier: Apache-2.0
// Rays that tell which element is seen in a direction: rows of form factors by Malley's method,
// cosine-distributed rays over the hemisphere (Malley 1988, "A shading method for computer
// generated images").
#pragma once

#include <cstdint>
#include <vector>

#include "exitance/math/warp.h"
#include "exitance/transport/element_rows.h"

namespace exitance {

/// A row that rays ended on and how many did; less than one where glass weakened it.
struct RowHits {
    std::uint32_t row = 0;
    float rays = 0;
};

class ElementCaster {
  public:
    /// `rays` per row, rounded up to whole packets of sixteen per place and to a power of two.
    ElementCaster(const ElementScene& scene, const ElementRows& rows, std::uint32_t rays,
                  std::uint64_t seed);

    std::uint32_t rays() const { return places_ * RayPacket::width; }

    /// What the open part of row `i` sees: `visit(row, rays)` for every end of a ray; places that
    /// stand under other things, or are another polygon's, cast none. Returns the number cast.
    template <class Visit>
    std::uint32_t cast_row(std::size_t i, const Visit& visit) const {
        return cast_places(i, [&](const Ends& ends) {
            for (std::uint32_t k = 0; k < ends.count; ++k) visit(ends.row[k], ends.rays[k]);
        });
    }
    /// The same: `visit(ends)` for every place, sixteen rays.
    template <class Visit>
    std::uint32_t cast_places(std::size_t i, const Visit& visit) const {
        std::uint32_t cast = 0;
        Ends ends;
        for (std::uint32_t place = 0; place < places_; ++place) {
            if (!cast_place(i, place, ends)) continue;
            cast += RayPacket::width;
            visit(ends);
        }
        return cast;
    }

    /// Ends of sixteen rays: where they stop, and the panes on their way.
    struct Ends {
        static constexpr std::uint32_t most = 16 * RayPacket::width;
        std::uint32_t count = 0;
        std::array<std::uint32_t, most> row;
        std::array<float, most> rays;      ///< less than one behind glass
        std::array<float, most> u, v;      ///< on the row's element, in Embree's coordinates
        std::array<float, most> distance;  ///< [m]
        std::uint32_t black = 0;           ///< rays that ended on the back of a one-sided polygon

        void add(const RayCaster::PacketHits& hits, std::uint32_t lane, float share) {
            if (count == most) return;
            row[count] = hits.primitive[lane], rays[count] = share;
            u[count] = hits.u[lane], v[count] = hits.v[lane];
            distance[count++] = hits.distance[lane];
        }
    };

    /// Packet `packet` of sixteen rays of those that tell what a point with unit normal sees; `key`
    /// picks their directions. Every power of two of packets is stratified.
    void cast_packet(const Vec3& point, const Vec3& normal, std::uint64_t key, std::uint32_t packet,
                     Ends& ends) const;

    /// Such a packet from `place` on row `row`, a point of the unit square; false if that stands
    /// under other things or is another polygon's.
    bool cast_from(std::size_t row, const UnitSquare& place, std::uint64_t key,
                   std::uint32_t packet, Ends& ends) const;

    /// The same of any rays, from origins relative to middle().
    void cast(const RayPacket& rays, Ends& ends) const;
    Vec3 middle() const { return caster_.middle(); }

    /// The same from one point with unit normal: `visit(row, rays)`. All rays() are cast.
    template <class Visit>
    void cast_point(const Vec3& point, const Vec3& normal, std::uint64_t key,
                    const Visit& visit) const {
        Ends ends;
        for (std::uint32_t packet = 0; packet < places_; ++packet) {
            cast_packet(point, normal, key, packet, ends);
            for (std::uint32_t k = 0; k < ends.count; ++k) visit(ends.row[k], ends.rays[k]);
        }
    }

    std::size_t bytes() const { return two_sided_.capacity(); }

  private:
    bool cast_place(std::size_t row, std::uint32_t place, Ends& ends) const;

    ElementScene scene_;
    const ElementRows& rows_;
    RayCaster caster_;             ///< over the elements
    std::vector<char> two_sided_;  ///< per row
    std::uint32_t places_;         ///< per row, sixteen rays from each
    std::uint64_t seed_;
};

}  // namespace exitance
