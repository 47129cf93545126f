// SPDX-License-Identifier: Apache-2.0
#include "exitance/visibility/visible_fraction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analytic/configuration_factors.h"
#include "exitance/formfactor/point_polygon.h"
#include "exitance/run/random.h"

namespace exitance {
namespace {

using analytic::parallel_rectangle;

struct Blockers {
    std::vector<Vec3> points;
    std::vector<RayCaster::Face> faces;
    void add(const std::array<Vec3, 4>& corners) {
        const auto first = static_cast<std::uint32_t>(points.size());
        points.insert(points.end(), corners.begin(), corners.end());
        faces.push_back({first, first + 1, first + 2, first + 3});
    }
};

RayBudget budget_of(std::uint8_t probe, std::uint16_t most) {
    RayBudget budget;
    budget.probe.fill(probe);
    budget.most.fill(most);
    return budget;
}

ReceiverBlock block_of(const Receivers& receivers, std::size_t n) {
    std::vector<std::uint32_t> which(n);
    for (std::size_t i = 0; i < n; ++i) which[i] = static_cast<std::uint32_t>(i);
    ReceiverBlock block;
    block.load(receivers, which.data(), n);
    return block;
}

// Mean and standard error over many receivers at one point, each with its own pattern.
struct Sampled {
    double fraction = 0, error = 0, disk = 0, rays = 0;
};

Sampled sample(const RayCaster& caster, const Source& source, const Vec3& point, const Vec3& normal,
               std::uint8_t probe, std::uint16_t most, int blocks = 8, bool occlusion = true) {
    Receivers receivers;
    constexpr std::size_t n = ReceiverBlock::capacity;
    for (std::uint32_t i = 0; i < n; ++i) receivers.add(point - caster.middle(), normal, i);
    const ReceiverBlock block = block_of(receivers, n);
    Sampled out;
    double sum = 0, square = 0;
    for (int b = 0; b < blocks; ++b) {
        VisibleFractions seen;
        find_visible_fractions(caster, source, block, budget_of(probe, most), occlusion,
                               static_cast<std::uint32_t>(hash_bits(b)), seen);
        for (std::size_t r = 0; r < n; ++r) {
            sum += double(seen.fraction[r]), square += std::pow(double(seen.fraction[r]), 2);
            out.disk += double(seen.disk[r]);
        }
        out.rays += double(seen.rays);
    }
    const double count = double(n) * blocks;
    out.fraction = sum / count;
    out.error = std::sqrt(std::max(0.0, square / count - out.fraction * out.fraction) / count);
    out.disk /= count, out.rays /= count;
    return out;
}

// A lamp [-1,1]² at z = 2 that faces down, half covered at z = 1 by [-2,0] × [-2,2].
struct HalfCovered {
    static constexpr std::array<Vec3, 4> lamp{{{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}}};
    RayCaster caster = [] {
        Blockers b;
        b.add(lamp);
        b.add({{{-2, -2, 1}, {0, -2, 1}, {0, 2, 1}, {-2, 2, 1}}});
        return RayCaster(b.points, b.faces);
    }();
    Source source{lamp, 4, caster.middle()};

    // The part of the lamp with x > 0 at the blocker is x > -px at the lamp.
    static double exact(double px, double py) {
        const double edge = std::clamp(-px, -1.0, 1.0);
        return parallel_rectangle(edge - px, 1 - px, -1 - py, 1 - py, 2) /
               parallel_rectangle(-1 - px, 1 - px, -1 - py, 1 - py, 2);
    }
};

TEST(VisibleFraction, IsUnbiasedWhereTheProbesCannotMissTheShadow) {
    const HalfCovered scene;
    // With a quarter of the lamp or more hidden and seen, four stratified probes always disagree.
    for (const double x : {0.0, 0.3, -0.4})
        for (const std::uint16_t most : {16, 64, 256}) {
            const Sampled s = sample(scene.caster, scene.source, {x, 0.2, 0}, {0, 0, 1},
                                     static_cast<std::uint8_t>(std::min<int>(most / 4, 16)), most);
            // Five standard errors; the ratio of two estimates is off by O(1/n).
            EXPECT_NEAR(s.fraction, HalfCovered::exact(x, 0.2), 5 * s.error + 0.05 / most)
                << "x " << x << ", at most " << most;
        }
    // Nor is it biased where there is no second round.
    for (const double x : {0.7, 0.93}) {
        const Sampled s = sample(scene.caster, scene.source, {x, 0.2, 0}, {0, 0, 1}, 64, 64);
        EXPECT_NEAR(s.fraction, HalfCovered::exact(x, 0.2), 5 * s.error + 0.001) << "x " << x;
    }
}

TEST(VisibleFraction, SliversThatTheProbesMissBiasByLessThanTheirShare) {
    const HalfCovered scene;
    for (const double x : {0.7, 0.93, 0.99})
        for (const int probe : {4, 8, 16}) {
            const Sampled s = sample(scene.caster, scene.source, {x, 0.2, 0}, {0, 0, 1},
                                     static_cast<std::uint8_t>(probe), 256);
            const double bias = s.fraction - HalfCovered::exact(x, 0.2);
            EXPECT_GT(bias, -5 * s.error - 0.001) << "x " << x << ", probes " << probe;
            EXPECT_LT(bias, 0.25 / probe) << "x " << x << ", probes " << probe;
        }
}

TEST(VisibleFraction, ErrorFallsFasterThanThatOfRandomSamples) {
    const HalfCovered scene;
    const Sampled few = sample(scene.caster, scene.source, {0.3, 0.2, 0}, {0, 0, 1}, 4, 16);
    const Sampled many = sample(scene.caster, scene.source, {0.3, 0.2, 0}, {0, 0, 1}, 64, 256);
    // n^-3/4 of a stratified set promises 8 for 16 times the rays, n^-1/2 only 4.
    EXPECT_GT(few.error / many.error, 6);
}

TEST(VisibleFraction, SeesAllOrNothingExactly) {
    const HalfCovered scene;
    EXPECT_EQ(sample(scene.caster, scene.source, {1.5, 0, 0}, {0, 0, 1}, 8, 64, 1).fraction, 1);
    EXPECT_EQ(sample(scene.caster, scene.source, {-1.5, 0, 0}, {0, 0, 1}, 8, 64, 1).fraction, 0);
}

TEST(VisibleFraction, StaysWithinItsBudget) {
    const HalfCovered scene;
    // All agree: the probes are all there is.
    EXPECT_EQ(sample(scene.caster, scene.source, {1.5, 0, 0}, {0, 0, 1}, 8, 64, 1).rays, 8);
    // They disagree for nearly everyone: most, but no more.
    const Sampled half = sample(scene.caster, scene.source, {0, 0, 0}, {0, 0, 1}, 16, 64, 1);
    EXPECT_LE(half.rays, 64);
    EXPECT_GT(half.rays, 63);
    EXPECT_EQ(sample(scene.caster, scene.source, {0, 0, 0}, {0, 0, 1}, 1, 1, 1).rays, 1);
    // Without occlusion there is nothing to ask.
    const Sampled none = sample(scene.caster, scene.source, {0, 0, 0}, {0, 0, 1}, 16, 64, 1, false);
    EXPECT_EQ(none.rays, 0);
    EXPECT_EQ(none.fraction, 1);
}

TEST(VisibleFraction, LeavesOutWhoHasNoProbe) {
    const HalfCovered scene;
    Receivers receivers;
    for (std::uint32_t i = 0; i < 40; ++i)
        receivers.add(Vec3{-1.5, 0, 0} - scene.caster.middle(), {0, 0, 1}, i);
    RayBudget budget = budget_of(4, 16);
    for (std::size_t i = 0; i < 40; i += 2) budget.probe[i] = 0;
    VisibleFractions seen;
    find_visible_fractions(scene.caster, scene.source, block_of(receivers, 40), budget, true, 1,
                           seen);
    EXPECT_EQ(seen.rays, 20u * 4);
    for (std::size_t i = 1; i < 40; i += 2) EXPECT_EQ(seen.fraction[i], 0.0f);
}

TEST(VisibleFraction, DependsOnKeyAndSeedAlone) {
    const HalfCovered scene;
    Receivers receivers;
    for (std::uint32_t i = 0; i < 100; ++i)
        receivers.add(Vec3{0.2, 0.01 * i, 0} - scene.caster.middle(), {0, 0, 1}, i);
    VisibleFractions all, again, other, one;
    find_visible_fractions(scene.caster, scene.source, block_of(receivers, 100), budget_of(8, 64),
                           true, 5, all);
    find_visible_fractions(scene.caster, scene.source, block_of(receivers, 100), budget_of(8, 64),
                           true, 5, again);
    find_visible_fractions(scene.caster, scene.source, block_of(receivers, 100), budget_of(8, 64),
                           true, 6, other);
    int different = 0;
    for (std::uint32_t i = 0; i < 100; ++i) {
        EXPECT_EQ(all.fraction[i], again.fraction[i]);
        different += all.fraction[i] != other.fraction[i];
        ReceiverBlock alone;  // whoever else is in the block
        alone.load(receivers, &i, 1);
        find_visible_fractions(scene.caster, scene.source, alone, budget_of(8, 64), true, 5, one);
        EXPECT_EQ(all.fraction[i], one.fraction[0]);
    }
    EXPECT_GT(different, 50);
}

TEST(VisibleFraction, CountsOnlyWhatIsAboveTheHorizon) {
    // A wall from z = -3 to z = 1, of which a floor point sees the upper quarter; a blocker hides
    // all that is below z = 0.5 at the wall and nothing above. By area 1/8 is seen; of the light
    // that would arrive it is the share between 0.5 and 1.
    const std::array<Vec3, 4> wall{{{2, 1, -3}, {2, -1, -3}, {2, -1, 1}, {2, 1, 1}}};
    Blockers b;
    b.add(wall);
    b.add({{{1, -5, -5}, {1, 5, -5}, {1, 5, 0.25}, {1, -5, 0.25}}});
    const RayCaster caster(b.points, b.faces);
    const Vec3 up{0, 0, 1};
    const std::array<Vec3, 4> seen{{{2, 1, 0.5}, {2, -1, 0.5}, {2, -1, 1}, {2, 1, 1}}};
    const double exact = point_polygon_factor({}, up, seen) / point_polygon_factor({}, up, wall);
    ASSERT_GT(exact, 0.6);
    const Sampled s = sample(caster, Source(wall, 4, caster.middle()), {}, up, 64, 256);
    EXPECT_NEAR(s.fraction, exact, 5 * s.error + 0.003);
}

TEST(VisibleFraction, DiskTendsToTheFactorWithManySamples) {
    // Wallace et al.'s sum of discs: exact in the limit, 1 % at 256 discs seen from one edge away.
    const HalfCovered scene;
    const double exact = parallel_rectangle(-1.5 - 1, -1.5 + 1, -1, 1, 2);
    const Sampled s = sample(scene.caster, scene.source, {1.5, 0, 0}, {0, 0, 1}, 255, 255, 1);
    EXPECT_NEAR(s.disk, exact, 0.01 * exact);
    const Sampled coarse = sample(scene.caster, scene.source, {1.5, 0, 0}, {0, 0, 1}, 16, 16, 4);
    EXPECT_NEAR(coarse.disk, exact, 0.05 * exact);
}

TEST(VisibleFraction, TrianglesAndGeneralQuadrilateralsAreSampledEvenly) {
    // A kite and a triangle, half hidden by a blocker whose edge is the line x = 0 of their plane
    // as seen from below the origin.
    Blockers b;
    const std::array<Vec3, 4> kite{{{-1.5, 0, 2}, {0.2, 0.6, 2}, {1, 0, 2}, {0.2, -0.9, 2}}};
    const std::array<Vec3, 4> triangle{{{-1.5, -0.3, 2}, {0.3, 1.2, 2}, {0.9, -0.8, 2}, {}}};
    b.add({{{-5, -5, 1}, {0, -5, 1}, {0, 5, 1}, {-5, 5, 1}}});
    b.add({{{-5, -5, 2.5}, {5, -5, 2.5}, {5, 5, 2.5}, {-5, 5, 2.5}}});
    const RayCaster caster(b.points, b.faces);
    const Vec3 up{0, 0, 1};
    const auto exact = [&](std::span<const Vec3> polygon) {
        std::vector<Vec3> right;  // clipped to x > 0
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Vec3 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
            if (p.x > 0) right.push_back(p);
            if ((p.x > 0) != (q.x > 0)) right.push_back(p + (q - p) * (p.x / (p.x - q.x)));
        }
        return point_polygon_factor({}, up, right) / point_polygon_factor({}, up, polygon);
    };
    for (const auto& [corners, n] : {std::pair{kite, 4u}, std::pair{triangle, 3u}}) {
        const double truth = exact({corners.data(), n});
        ASSERT_TRUE(truth > 0.1 && truth < 0.9) << truth;
        const Sampled s = sample(caster, Source(corners, n, caster.middle()), {}, up, 64, 256);
        EXPECT_NEAR(s.fraction, truth, 5 * s.error + 0.002) << n << " corners";
    }
}

}  // namespace
}  // namespace exitance
