// SPDX-License-Identifier: Apache-2.0
// Who sees whom: Embree over triangles, in packets of 16 where there are many rays.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "exitance/math/vector.h"

namespace exitance {

struct RayHit {
    std::uint32_t primitive = 0;  ///< index of the triangle or quad that was given
    float distance = 0;           ///< in lengths of the direction
    float u = 0, v = 0;           ///< Embree's coordinates on the primitive
    Vec3f geometric_normal;       ///< not unit length, right-hand rule over the corners
};

/// Sixteen rays side by side, as Embree takes them. `active` is a bit mask.
struct alignas(64) RayPacket {
    static constexpr std::size_t width = 16;
    std::array<float, width> origin_x, origin_y, origin_z, near;
    std::array<float, width> direction_x, direction_y, direction_z, far;
    std::uint32_t active = 0;

    /// Makes ray `lane` active; `near` and `far` stay as they are.
    void aim(std::size_t lane, const Vec3& origin, const Vec3& direction) {
        origin_x[lane] = static_cast<float>(origin.x);
        origin_y[lane] = static_cast<float>(origin.y);
        origin_z[lane] = static_cast<float>(origin.z);
        direction_x[lane] = static_cast<float>(direction.x);
        direction_y[lane] = static_cast<float>(direction.y);
        direction_z[lane] = static_cast<float>(direction.z);
        active |= 1u << lane;
    }
};

/// Polygons that block light. Threads may query one caster at once.
class RayCaster {
  public:
    using Face = std::array<std::uint32_t, 4>;  ///< corners; the last two equal for a triangle

    /// `faces` index `points`; positions are stored in float relative to the middle of the scene.
    /// closest() goes through the back of face i where `open_backs[i]`; none by default. Face i is
    /// glass where `transmittance[i]` > 0, the share of light that goes straight through it: it
    /// does not occlude. Throws Error(could_not_finish) when Embree runs out of memory.
    RayCaster(std::span<const Vec3> points, std::span<const Face> faces,
              std::vector<char> open_backs = {}, std::vector<float> transmittance = {});
    ~RayCaster();
    RayCaster(RayCaster&&) noexcept;
    RayCaster& operator=(RayCaster&&) noexcept;

    /// Offset that keeps a ray clear of the surface it starts on [m]: a few float steps of the
    /// scene.
    double clearance() const;
    /// What the packets' origins are relative to; subtract it before conversion to float.
    Vec3 middle() const;

    /// Bit i set: ray i is blocked strictly between near and far.
    std::uint32_t occluded(const RayPacket& rays) const;
    bool occluded(const Vec3& from, const Vec3& to) const;
    /// The same, and what share of the light along each ray the glass on its way lets through.
    std::uint32_t occluded(const RayPacket& rays,
                           std::array<float, RayPacket::width>& through) const;

    bool has_glass() const;
    /// Of a face: the share of light that goes straight through; 0 = it blocks.
    float transmittance(std::uint32_t primitive) const;
    /// The nearest primitive, glass too, on the ray from `origin` along `direction`, within (near,
    /// far).
    std::optional<RayHit> closest(const Vec3& origin, const Vec3& direction, double near,
                                  double far) const;
    /// Nearest hits of a packet: primitive index (none = 0xffffffff), distance, and whether the
    /// front was hit (direction against the geometric normal).
    struct PacketHits {
        std::array<std::uint32_t, RayPacket::width> primitive;
        std::array<float, RayPacket::width> distance, u, v;
        std::uint32_t front = 0;  ///< bit mask
    };
    void closest(const RayPacket& rays, PacketHits& hits) const;

    /// Calls `visit(primitive, radius)` for every primitive whose bounds come within `radius` of
    /// `point`, and for some others near it; it returns the radius to go on with, no larger.
    void visit_near(const Vec3& point, double radius,
                    const std::function<double(std::uint32_t, double)>& visit) const;

  private:
    struct Embree;
    std::unique_ptr<Embree> embree_;
    Vec3 middle_;
    double clearance_ = 0;
    bool empty_ = false;
};

}  // namespace exitance
