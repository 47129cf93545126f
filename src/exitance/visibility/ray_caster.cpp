// SPDX-License-Identifier: Apache-2.0
#include "exitance/visibility/ray_caster.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "exitance/math/box.h"
#include "exitance/run/error.h"

namespace exitance {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

void check(RTCDevice device, const char* doing) {
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE)
        throw Error(Fault::could_not_finish,
                    std::string("Embree failed while ") + doing +
                        (error == RTC_ERROR_OUT_OF_MEMORY ? ": out of memory" : ""));
}

void fill(RTCRay16& ray, const RayPacket& rays) {
    std::memcpy(ray.org_x, rays.origin_x.data(), sizeof ray.org_x);
    std::memcpy(ray.org_y, rays.origin_y.data(), sizeof ray.org_y);
    std::memcpy(ray.org_z, rays.origin_z.data(), sizeof ray.org_z);
    std::memcpy(ray.tnear, rays.near.data(), sizeof ray.tnear);
    std::memcpy(ray.dir_x, rays.direction_x.data(), sizeof ray.dir_x);
    std::memcpy(ray.dir_y, rays.direction_y.data(), sizeof ray.dir_y);
    std::memcpy(ray.dir_z, rays.direction_z.data(), sizeof ray.dir_z);
    std::memcpy(ray.tfar, rays.far.data(), sizeof ray.tfar);
    std::fill_n(ray.time, RayPacket::width, 0.0f);
    std::fill_n(ray.mask, RayPacket::width, ~0u);
    std::fill_n(ray.flags, RayPacket::width, 0u);
}

struct alignas(64) LaneMask {
    std::array<int, RayPacket::width> lanes;

    explicit LaneMask(std::uint32_t active) {
        for (std::size_t i = 0; i < RayPacket::width; ++i) lanes[i] = (active >> i & 1u) ? -1 : 0;
    }
};

/// What the filters know of the faces.
struct FilteredFaces {
    std::vector<char> open_backs;  ///< empty, or per face
    std::vector<float> transmittance;
};

// Hits on the back of a face that is open there do not count.
void reject_open_backs(const RTCFilterFunctionNArguments* query) {
    const auto& open_backs = static_cast<const FilteredFaces*>(query->geometryUserPtr)->open_backs;
    const unsigned n = query->N;
    for (unsigned i = 0; i < n; ++i) {
        if (query->valid[i] != -1) continue;
        const float facing = RTCHitN_Ng_x(query->hit, n, i) * RTCRayN_dir_x(query->ray, n, i) +
                             RTCHitN_Ng_y(query->hit, n, i) * RTCRayN_dir_y(query->ray, n, i) +
                             RTCHitN_Ng_z(query->hit, n, i) * RTCRayN_dir_z(query->ray, n, i);
        if (facing >= 0 && open_backs[RTCHitN_primID(query->hit, n, i)]) query->valid[i] = 0;
    }
}

// Rays that ask what glass lets through carry it along, by their ids, and where they last went
// through some: on an edge between two faces of one pane both report the ray.
struct GlassContext : RTCIntersectContext {
    static constexpr std::size_t remembered = 8;

    float* through = nullptr;
    float clearance = 0;  ///< panes closer to each other than this are one [m]
    std::array<std::array<float, remembered>, RayPacket::width> crossed;
    std::array<unsigned, RayPacket::width> count{};

    /// Whether no pane has been met at `distance` [lengths of the direction] before.
    bool is_first(unsigned ray, float distance, float direction_length) {
        const unsigned known = std::min<unsigned>(count[ray], remembered);
        for (unsigned k = 0; k < known; ++k)
            if (std::abs(crossed[ray][k] - distance) * direction_length <= clearance) return false;
        crossed[ray][count[ray]++ % remembered] = distance;
        return true;
    }
};

// Shadow rays go through glass. The back of a face that is open there is the other side of one
// that counts.
void pass_through_glass(const RTCFilterFunctionNArguments* query) {
    const auto& faces = *static_cast<const FilteredFaces*>(query->geometryUserPtr);
    auto& context = *static_cast<GlassContext*>(query->context);
    const unsigned n = query->N;
    for (unsigned i = 0; i < n; ++i) {
        if (query->valid[i] != -1) continue;
        const unsigned primitive = RTCHitN_primID(query->hit, n, i);
        const float transmittance = faces.transmittance[primitive];
        if (!(transmittance > 0)) continue;
        query->valid[i] = 0;
        if (!context.through) continue;
        const float facing = RTCHitN_Ng_x(query->hit, n, i) * RTCRayN_dir_x(query->ray, n, i) +
                             RTCHitN_Ng_y(query->hit, n, i) * RTCRayN_dir_y(query->ray, n, i) +
                             RTCHitN_Ng_z(query->hit, n, i) * RTCRayN_dir_z(query->ray, n, i);
        if (facing >= 0 && !faces.open_backs.empty() && faces.open_backs[primitive]) continue;
        const unsigned ray = RTCRayN_id(query->ray, n, i);
        const float length =
            std::hypot(RTCRayN_dir_x(query->ray, n, i), RTCRayN_dir_y(query->ray, n, i),
                       RTCRayN_dir_z(query->ray, n, i));
        if (context.is_first(ray, RTCRayN_tfar(query->ray, n, i), length))
            context.through[ray] *= transmittance;
    }
}

}  // namespace

struct RayCaster::Embree {
    FilteredFaces faces;
    bool has_glass = false;
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = nullptr;

    Embree() {
        if (!device) throw Error(Fault::could_not_finish, "Embree could not start");
        scene = rtcNewScene(device);
    }
    ~Embree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;
};

RayCaster::RayCaster(std::span<const Vec3> points, std::span<const Face> faces,
                     std::vector<char> open_backs, std::vector<float> transmittance)
    : embree_(std::make_unique<Embree>()) {
    Box box;
    for (const Face& face : faces)
        for (const std::uint32_t corner : face) box.add(points[corner]);
    middle_ = box.empty() ? Vec3{} : box.centre();
    empty_ = faces.empty();
    // Coordinates relative to the middle have float steps of at most 2⁻²⁵ of the diagonal; ray
    // origins, hit distances and triangles each add a few of them.
    clearance_ = std::max(box.diagonal(), 1e-30) * 0x1.0p-19;

    RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_QUAD);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), std::max<std::size_t>(1, points.size())));
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4,
                                4 * sizeof(std::uint32_t), std::max<std::size_t>(1, faces.size())));
    check(embree_->device, "making room for the scene");
    std::fill_n(vertices, 3, 0.0f);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            vertices[3 * i + axis] = static_cast<float>(points[i][axis] - middle_[axis]);
    std::fill_n(indices, 4, 0u);
    for (std::size_t i = 0; i < faces.size(); ++i)
        std::copy(faces[i].begin(), faces[i].end(), indices + 4 * i);
    embree_->faces = {std::move(open_backs), std::move(transmittance)};
    const auto& passes = embree_->faces.transmittance;
    embree_->has_glass = std::any_of(passes.begin(), passes.end(), [](float t) { return t > 0; });
    rtcSetGeometryUserData(geometry, &embree_->faces);
    if (!embree_->faces.open_backs.empty())
        rtcSetGeometryIntersectFilterFunction(geometry, reject_open_backs);
    if (embree_->has_glass) rtcSetGeometryOccludedFilterFunction(geometry, pass_through_glass);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(embree_->scene, geometry);
    rtcReleaseGeometry(geometry);
    // Robust: no ray slips between two faces that share an edge, but for a few in ten thousand of
    // those aimed at an edge to the last bit.
    rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(embree_->scene);
    check(embree_->device, "building its hierarchy");
}

RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

double RayCaster::clearance() const {
    return clearance_;
}
Vec3 RayCaster::middle() const {
    return middle_;
}

bool RayCaster::has_glass() const {
    return embree_->has_glass;
}
float RayCaster::transmittance(std::uint32_t primitive) const {
    return embree_->has_glass ? embree_->faces.transmittance[primitive] : 0.0f;
}

namespace {

std::uint32_t occluded_by(RTCScene scene, const RayPacket& rays, float* through, float clearance) {
    RTCRay16 ray;
    fill(ray, rays);
    for (unsigned i = 0; i < RayPacket::width; ++i) ray.id[i] = i;
    const LaneMask mask(rays.active);
    GlassContext context;
    rtcInitIntersectContext(&context);
    context.through = through;
    context.clearance = clearance;
    rtcOccluded16(mask.lanes.data(), scene, &context, &ray);
    std::uint32_t blocked = 0;
    for (std::size_t i = 0; i < RayPacket::width; ++i)
        blocked |= (ray.tfar[i] == -infinity ? 1u : 0u) << i;
    return blocked & rays.active;
}

}  // namespace

std::uint32_t RayCaster::occluded(const RayPacket& rays) const {
    return occluded_by(embree_->scene, rays, nullptr, 0);
}

std::uint32_t RayCaster::occluded(const RayPacket& rays,
                                  std::array<float, RayPacket::width>& through) const {
    through.fill(1.0f);
    return occluded_by(embree_->scene, rays, embree_->has_glass ? through.data() : nullptr,
                       static_cast<float>(clearance_));
}

bool RayCaster::occluded(const Vec3& from, const Vec3& to) const {
    const Vec3f origin(from - middle_), direction(to - from);
    RTCRay ray{};
    ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
    ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
    ray.tnear = 0, ray.tfar = 1, ray.mask = ~0u;
    GlassContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(embree_->scene, &context, &ray);
    return ray.tfar < 0;
}

std::optional<RayHit> RayCaster::closest(const Vec3& origin, const Vec3& direction, double near,
                                         double far) const {
    const Vec3f o(origin - middle_), d(direction);
    RTCRayHit query{};
    query.ray.org_x = o.x, query.ray.org_y = o.y, query.ray.org_z = o.z;
    query.ray.dir_x = d.x, query.ray.dir_y = d.y, query.ray.dir_z = d.z;
    query.ray.tnear = static_cast<float>(near);
    query.ray.tfar = static_cast<float>(far);
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(embree_->scene, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return RayHit{query.hit.primID,
                  query.ray.tfar,
                  query.hit.u,
                  query.hit.v,
                  {query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z}};
}

void RayCaster::closest(const RayPacket& rays, PacketHits& hits) const {
    RTCRayHit16 query;
    fill(query.ray, rays);
    std::fill_n(query.hit.geomID, RayPacket::width, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(query.hit.instID[0], RayPacket::width, RTC_INVALID_GEOMETRY_ID);
    const LaneMask mask(rays.active);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect16(mask.lanes.data(), embree_->scene, &context, &query);
    hits.front = 0;
    for (std::size_t i = 0; i < RayPacket::width; ++i) {
        const bool hit = (rays.active >> i & 1u) && query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
        hits.primitive[i] = hit ? query.hit.primID[i] : 0xffffffffu;
        hits.distance[i] = query.ray.tfar[i];
        hits.u[i] = query.hit.u[i];
        hits.v[i] = query.hit.v[i];
        const float facing = query.hit.Ng_x[i] * rays.direction_x[i] +
                             query.hit.Ng_y[i] * rays.direction_y[i] +
                             query.hit.Ng_z[i] * rays.direction_z[i];
        hits.front |= (hit && facing < 0 ? 1u : 0u) << i;
    }
}

void RayCaster::visit_near(const Vec3& point, double radius,
                           const std::function<double(std::uint32_t, double)>& visit) const {
    if (empty_) return;
    const Vec3f p(point - middle_);
    RTCPointQuery query{p.x, p.y, p.z, 0.0f, static_cast<float>(radius)};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    using Visit = const std::function<double(std::uint32_t, double)>*;
    const auto shrink = [](RTCPointQueryFunctionArguments* found) {
        const Visit visitor = *static_cast<Visit*>(found->userPtr);
        const double now = double(found->query->radius);
        const auto next = static_cast<float>((*visitor)(found->primID, now));
        if (!(next < found->query->radius)) return false;
        found->query->radius = next;
        return true;
    };
    Visit visitor = &visit;
    rtcPointQuery(embree_->scene, &query, &context, shrink, &visitor);
}

}  // namespace exitance
