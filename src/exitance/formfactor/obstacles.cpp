// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/obstacles.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "exitance/formfactor/obstructed_view.h"
#include "exitance/math/frame.h"
#include "exitance/visibility/polygon_block.h"
#include "exitance/visibility/shaft.h"

namespace exitance {

namespace {

// Receivers are placed in float: lengths that are rounding, in diagonals of the scene.
constexpr double rounding = 5e-7;

// Receivers that are looked at together at most, and at least where many obstacles stand.
constexpr std::size_t most_together = 64, fewest_together = 16;

// A view meets each rim with every other one; above this rays are cheaper.
constexpr std::size_t most_rims = 40;

// What looking for obstacles costs, in rays.
constexpr unsigned fewest_rays = 256;

std::vector<Box> bounds_of(std::span<const Blocker> blockers) {
    std::vector<Box> boxes;
    for (const Blocker& blocker : blockers) boxes.push_back(blocker.bounds);
    return boxes;
}

class Viewer {
  public:
    Viewer(const Obstacles& obstacles, const Source& source, const ReceiverBlock& receivers,
           std::span<const std::uint8_t> rays, double clearance, ViewsOfSource& views)
        : obstacles_(obstacles),
          source_(source),
          receivers_(receivers),
          rays_(rays),
          clearance_(clearance),
          views_(views),
          slack_(obstacles.slack()),
          plane_{Vec3(source.normal), dot(Vec3(source.normal), Vec3(source.corners[0]))} {
        for (std::uint32_t c = 0; c < source.count; ++c) outline_.add(Vec3(source.corners[c]));
    }

    void run() {
        Box all;
        for (std::size_t r = 0; r < receivers_.size; ++r)
            if (rays_[r] > 0) all.add(point(r));
        if (all.empty()) return;
        Box there;
        for (const Vec3& p : outline_.corners()) there.add(p);
        const Shaft shaft(all, there);
        obstacles_.tree().for_accepted([&](const Box& box) { return !shaft.misses(box); },
                                       [&](std::uint32_t k) { near_.push_back(k); });
        for (std::size_t begin = 0; begin < receivers_.size;) {
            const std::size_t end = end_of_run(begin);
            look(begin, end);
            begin = end;
        }
    }

  private:
    // Receivers in the plane of the first.
    std::size_t end_of_run(std::size_t begin) const {
        const Plane plane = plane_of(begin);
        std::size_t end = begin + 1;
        while (end < receivers_.size && end - begin < most_together &&
               receivers_.nx[end] == receivers_.nx[begin] &&
               receivers_.ny[end] == receivers_.ny[begin] &&
               receivers_.nz[end] == receivers_.nz[begin] &&
               std::abs(plane.height(point(end))) <= slack_)
            ++end;
        return end;
    }
    Vec3 point(std::size_t r) const {
        return Vec3{receivers_.x[r], receivers_.y[r], receivers_.z[r]} + normal(r) * clearance_;
    }
    Vec3 normal(std::size_t r) const {
        return {receivers_.nx[r], receivers_.ny[r], receivers_.nz[r]};
    }
    Plane plane_of(std::size_t r) const {
        const Vec3 n = normal(r);
        return {n, dot(n, point(r))};
    }

    void know(std::size_t begin, std::size_t end, float visible) {
        for (std::size_t r = begin; r < end; ++r) {
            views_.visible[r] = visible;
            views_.known[r] = true;
        }
    }

    void look(std::size_t begin, std::size_t end) {
        while (begin < end && rays_[begin] == 0) ++begin;
        while (end > begin && rays_[end - 1] == 0) --end;
        const auto part = rays_.subspan(begin, end - begin);
        if (std::accumulate(part.begin(), part.end(), 0u) < fewest_rays) return;
        const Plane plane = plane_of(begin);
        const SmallPolygon target = clip(outline_, plane, slack_);
        const SmallPolygon from = clip(hull(begin, end, plane.normal), plane_, slack_);
        if (target.empty() || from.empty()) return know(begin, end, 1.0f);
        if (!find_obstacles(from, target)) return know(begin, end, 0.0f);
        if (standing_.empty()) return know(begin, end, 1.0f);
        std::size_t rims = 0;
        for (const Obstacle& obstacle : standing_) rims += obstacle.rims.size();
        if (rims <= most_rims) return view_all(begin, end, plane, target);
        if (end - begin <= fewest_together) return;
        const std::size_t middle = begin + (end - begin) / 2;
        look(begin, middle);
        look(middle, end);
    }

    // A rectangle around the receivers in their plane.
    SmallPolygon hull(std::size_t begin, std::size_t end, const Vec3& n) const {
        const Frame frame(n);
        Box box;
        for (std::size_t r = begin; r < end; ++r) {
            const Vec3 p = point(r);
            box.add({dot(p, frame.tangent), dot(p, frame.bitangent), dot(p, n)});
        }
        const double x = box.upper.x - box.lower.x + slack_, y = box.upper.y - box.lower.y + slack_;
        SmallPolygon out;
        for (const auto& [u, v] : {std::pair{0.0, 0.0}, {x, 0.0}, {x, y}, {0.0, y}})
            out.add(frame.to_world({box.lower.x + u, box.lower.y + v, box.lower.z}));
        return out;
    }

    // False if one hides everything.
    bool find_obstacles(const SmallPolygon& from, const SmallPolygon& target) {
        standing_.clear();
        cut_.clear();
        found_.clear();
        Box here, there;
        for (const Vec3& p : from.corners()) here.add(p);
        for (const Vec3& p : target.corners()) there.add(p);
        const Shaft shaft(here, there);
        for (const std::uint32_t k : near_)
            if (!shaft.misses(obstacles_.blockers()[k].bounds)) found_.push_back(k);
        cut_.reserve(found_.size());
        if (rims_.size() < found_.size()) rims_.resize(found_.size());
        for (std::size_t k = 0; k < found_.size(); ++k) {
            const Blocker* blocker = &obstacles_.blockers()[found_[k]];
            for (const Vec3& corner : blocker->corners)
                if (plane_.height(corner) < -slack_) {
                    auto before = cut(*blocker, plane_, slack_);
                    blocker = before ? &cut_.emplace_back(std::move(*before)) : nullptr;
                    break;
                }
            if (!blocker) continue;
            const Stand stand =
                find_rims(*blocker, from.corners(), target.corners(), slack_, rims_[k]);
            if (stand == Stand::hides) return false;
            // Edges that can be seen from the other side may tell what these cannot.
            if (stand == Stand::apart || find_rims(*blocker, target.corners(), from.corners(),
                                                   slack_, back_rims_) == Stand::apart)
                continue;
            standing_.push_back({blocker, rims_[k]});
        }
        return true;
    }

    void view_all(std::size_t begin, std::size_t end, const Plane& plane,
                  const SmallPolygon& target) {
        const Vec3 origin = outline_.at[0];
        double reach = 0;
        for (const Vec3& p : target.corners()) reach = std::max(reach, length(p - point(begin)));
        target_.set(target, plane_, plane.normal, standing_, origin, 1 / reach);
        Viewpoints points;
        ViewFactors factors;
        for (std::size_t first = begin; first < end; first += Viewpoints::capacity) {
            const std::size_t count = std::min(Viewpoints::capacity, end - first);
            for (std::size_t k = 0; k < Viewpoints::capacity; ++k)
                points.set(k, target_.local(point(first + std::min(k, count - 1))));
            view(target_, points, factors);
            for (std::size_t k = 0; k < count; ++k)
                know(first + k, first + k + 1,
                     factors.free[k] > 0 ? factors.seen[k] / factors.free[k] : 1.0f);
        }
    }

    const Obstacles& obstacles_;
    const Source& source_;
    const ReceiverBlock& receivers_;
    std::span<const std::uint8_t> rays_;
    double clearance_;
    ViewsOfSource& views_;
    double slack_;
    Plane plane_;
    SmallPolygon outline_;
    ObstructedTarget target_;
    std::vector<std::uint32_t> near_;   ///< may stand before any of the block
    std::vector<std::uint32_t> found_;  ///< may stand before those that are looked at
    std::vector<Blocker> cut_;
    std::vector<std::vector<std::uint32_t>> rims_;
    std::vector<std::uint32_t> back_rims_;
    std::vector<Obstacle> standing_;
};

}  // namespace

Obstacles::Obstacles(std::span<const std::span<const Vec3>> polygons)
    : blockers_(find_blockers(polygons)), tree_(bounds_of(blockers_)) {
    Box bounds;
    for (const auto& polygon : polygons)
        for (const Vec3& p : polygon) bounds.add(p);
    slack_ = rounding * bounds.diagonal();
}

std::size_t Obstacles::bytes() const {
    std::size_t sum = 0;
    for (const Blocker& blocker : blockers_) sum += blocker.bytes();
    return sum;
}

void view_source(const Obstacles& obstacles, const Source& source, const ReceiverBlock& receivers,
                 std::span<const std::uint8_t> rays, double clearance, ViewsOfSource& views) {
    views.known.fill(false);
    Viewer(obstacles, source, receivers, rays, clearance, views).run();
}

}  // namespace exitance
