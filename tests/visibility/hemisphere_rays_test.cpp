// SPDX-License-Identifier: Apache-2.0
#include "exitance/visibility/hemisphere_rays.h"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/run/random.h"

namespace exitance {
namespace {

struct Sums {
    double cosine = 0, square = 0, across = 0, side = 0;
    double longest = 0, shortest = 2;
};

Sums sums_of(const Vec3f& normal, std::uint64_t key, std::uint32_t packets) {
    Sums out;
    const Vec3f across = normalized(cross(normal, Vec3f{0.3f, -0.8f, 0.5f}));
    for (std::uint32_t p = 0; p < packets; ++p) {
        RayPacket rays;
        aim_hemisphere(rays, {1, 2, 3}, normal, key, p);
        EXPECT_EQ(rays.active, 0xffffu);
        for (std::size_t k = 0; k < RayPacket::width; ++k) {
            EXPECT_EQ(rays.origin_x[k], 1);
            EXPECT_EQ(rays.near[k], 0);
            const Vec3f d{rays.direction_x[k], rays.direction_y[k], rays.direction_z[k]};
            const double n = double(packets) * RayPacket::width, c = double(dot(d, normal));
            EXPECT_GE(c, 0);
            out.cosine += c / n, out.square += c * c / n;
            out.across += std::pow(double(dot(d, across)), 2) / n;
            out.side += (dot(d, across) > 0 ? 1 : 0) / n;
            out.longest = std::max(out.longest, double(length(d)));
            out.shortest = std::min(out.shortest, double(length(d)));
        }
    }
    return out;
}

// Of the density cosθ / π: ⟨cosθ⟩ = 2/3, ⟨cos²θ⟩ = 1/2, ⟨(d·t)²⟩ = 1/4 for a tangent t.
TEST(HemisphereRays, AreSpreadByTheCosine) {
    for (std::uint64_t s = 0; s < 20; ++s) {
        const auto place = low_discrepancy(77, static_cast<std::uint32_t>(s));
        const double z = 2 * place[0] - 1, phi = 6.283185307 * place[1], r = std::sqrt(1 - z * z);
        const Vec3f normal(Vec3{r * std::cos(phi), r * std::sin(phi), z});
        const Sums found = sums_of(normal, hash_bits(s), 256);
        // 4096 stratified rays miss smooth means by far less than 4096^-1/2 = 1.6 %.
        EXPECT_NEAR(found.cosine, 2.0 / 3, 0.001) << s;
        EXPECT_NEAR(found.square, 0.5, 0.001) << s;
        EXPECT_NEAR(found.across, 0.25, 0.002) << s;
        EXPECT_NEAR(found.side, 0.5, 0.01) << s;
        EXPECT_NEAR(found.longest, 1, 1e-5) << s;
        EXPECT_NEAR(found.shortest, 1, 1e-5) << s;
    }
}

TEST(HemisphereRays, EveryPowerOfTwoIsStratified) {
    for (std::uint64_t key = 0; key < 50; ++key)
        for (const std::uint32_t packets : {1u, 2u, 4u, 16u}) {
            const double n = 16.0 * packets;
            // cos²θ is 1 − u, and one of n strata of u holds one sample each.
            EXPECT_NEAR(sums_of({0, 0, 1}, hash_bits(key), packets).square, 0.5, 0.51 / n) << key;
        }
}

TEST(HemisphereRays, KeysDiffer) {
    RayPacket a, b;
    aim_hemisphere(a, {}, {0, 0, 1}, hash_bits(1), 0);
    aim_hemisphere(b, {}, {0, 0, 1}, hash_bits(2), 0);
    EXPECT_NE(a.direction_x, b.direction_x);
}

}  // namespace
}  // namespace exitance
