// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/obstacles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "analytic/configuration_factors.h"
#include "exitance/run/random.h"
#include "exitance/visibility/visible_fraction.h"

namespace exitance {
namespace {

using Quad = std::array<Vec3, 4>;

// Two plates with a box and a slanted sheet between: what points on the lower see of the upper.
struct Room {
    Quad lamp{{{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}}};
    std::vector<Quad> quads{lamp, {{{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}}}};
    Receivers points;

    void add_box(const Vec3& low, const Vec3& high) {
        const auto at = [&](int x, int y, int z) {
            return Vec3{x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z};
        };
        quads.push_back({at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0)});
        quads.push_back({at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)});
        quads.push_back({at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)});
        quads.push_back({at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0)});
        quads.push_back({at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)});
        quads.push_back({at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)});
    }
    void add_floor_grid(int count) {
        for (int j = 0; j < count; ++j)
            for (int i = 0; i < count; ++i)
                points.add({-2.9 + 5.8 * i / (count - 1), -2.9 + 5.8 * j / (count - 1), 0},
                           {0, 0, 1}, static_cast<std::uint32_t>(points.size()));
    }
    Obstacles obstacles() const {
        std::vector<std::span<const Vec3>> outlines;
        for (const Quad& quad : quads) outlines.emplace_back(quad);
        return Obstacles(outlines);
    }
    RayCaster caster() const {
        std::vector<Vec3> corners;
        std::vector<RayCaster::Face> faces;
        for (const Quad& quad : quads) {
            const auto first = static_cast<std::uint32_t>(corners.size());
            corners.insert(corners.end(), quad.begin(), quad.end());
            faces.push_back({first, first + 1, first + 2, first + 3});
        }
        return RayCaster(corners, faces);
    }
};

struct Seen {
    ReceiverBlock block;
    ViewsOfSource views;

    explicit Seen(const Room& room, std::uint8_t rays = 64) {
        std::vector<std::uint32_t> which(room.points.size());
        std::iota(which.begin(), which.end(), 0u);
        block.load(room.points, which.data(), which.size());
        const std::vector<std::uint8_t> each(ReceiverBlock::capacity, rays);
        view_source(room.obstacles(), Source(room.lamp, 4, {}), block,
                    std::span(each).first(block.size), 1e-6, views);
    }
};

TEST(Obstacles, ASquareHidesWhatTheClosedFormSays) {
    Room room;
    room.quads.push_back({{{-0.4, -0.4, 1}, {0.4, -0.4, 1}, {0.4, 0.4, 1}, {-0.4, 0.4, 1}}});
    room.add_floor_grid(15);
    const Seen seen(room);
    for (std::size_t i = 0; i < room.points.size(); ++i) {
        const double x = room.points.x[i], y = room.points.y[i];
        const double x0 = std::clamp(-0.8 - x, -1.0, 1.0), x1 = std::clamp(0.8 - x, -1.0, 1.0);
        const double y0 = std::clamp(-0.8 - y, -1.0, 1.0), y1 = std::clamp(0.8 - y, -1.0, 1.0);
        using analytic::parallel_rectangle;
        const double whole = parallel_rectangle(-1 - x, 1 - x, -1 - y, 1 - y, 2);
        const double hidden = parallel_rectangle(x0 - x, x1 - x, y0 - y, y1 - y, 2);
        ASSERT_TRUE(seen.views.known[i]);
        // Float: a few millionths of a factor near 0.3, divided by one that may be a tenth of it.
        EXPECT_NEAR(double(seen.views.visible[i]), 1 - hidden / whole, 1e-4) << x << ", " << y;
    }
}

TEST(Obstacles, AgreeWithRays) {
    Room room;
    room.add_box({-0.9, -0.3, 0.2}, {-0.1, 0.5, 1.1});
    room.add_box({0.3, -0.8, 0.0}, {0.9, 0.1, 0.7});
    room.quads.push_back({{{-0.5, -1, 1.2}, {0.6, -1, 1.5}, {0.6, -0.2, 1.5}, {-0.5, -0.2, 1.2}}});
    room.add_floor_grid(16);
    const Seen seen(room);
    const RayCaster caster = room.caster();
    RayBudget budget;
    budget.probe.fill(255);
    budget.most.fill(RayBudget::largest);
    ReceiverBlock moved = seen.block;  // rays are cast relative to the middle of the scene
    const Vec3f middle(caster.middle());
    for (std::size_t i = 0; i < moved.size; ++i)
        moved.x[i] -= middle.x, moved.y[i] -= middle.y, moved.z[i] -= middle.z;
    VisibleFractions rays;
    find_visible_fractions(caster, Source(room.lamp, 4, caster.middle()), moved, budget, true, 0,
                           rays);
    int partly = 0;
    for (std::size_t i = 0; i < room.points.size(); ++i) {
        ASSERT_TRUE(seen.views.known[i]);
        const float x = room.points.x[i], y = room.points.y[i];
        if (x > 0.25f && x < 0.95f && y > -0.85f && y < 0.15f) continue;  // under the box
        partly += rays.deviation[i] > 0 ? 1 : 0;
        // Four deviations of 1024 rays, and what all of 255 may miss.
        EXPECT_NEAR(seen.views.visible[i], rays.fraction[i], 4 * rays.deviation[i] + 2e-3f)
            << x << ", " << y;
    }
    EXPECT_GT(partly, 40) << "the test is about penumbrae";
}

TEST(Obstacles, FewRaysAreNotWorthTheSearch) {
    Room room;
    room.add_floor_grid(15);
    const Seen seen(room, 1);
    for (std::size_t i = 0; i < room.points.size(); ++i) EXPECT_FALSE(seen.views.known[i]);
}

TEST(Obstacles, TooManyAreLeftToRays) {
    Room room;
    for (int i = 0; i < 40; ++i) {
        const double x = -0.9 + 0.045 * i;
        room.quads.push_back({{{x, -1, 1}, {x + 0.02, -1, 1}, {x + 0.02, 1, 1}, {x, 1, 1}}});
    }
    room.add_floor_grid(15);
    const Seen seen(room);
    EXPECT_FALSE(seen.views.known[7 * 15 + 7]) << "under a grating of forty bars";
}

}  // namespace
}  // namespace exitance
