// SPDX-License-Identifier: Apache-2.0
#include "exitance/visibility/hemisphere_rays.h"

#include <cmath>
#include <limits>

#include "exitance/math/frame.h"
#include "exitance/math/multiversion.h"
#include "exitance/run/random.h"

namespace exitance {

namespace {

constexpr std::size_t width = RayPacket::width;

// The sequence is linear in the bits of its index: a packet's points are its first one, digit by
// digit plus those of the first packet.
constexpr auto first_packet = [] {
    std::array<std::array<std::uint32_t, width>, 2> points{};
    for (std::uint32_t k = 0; k < width; ++k)
        points[0][k] = sobol(k)[0], points[1][k] = sobol(k)[1];
    return points;
}();

// sin 2πx for |x| ≤ 1/4: Taylor's series to the ninth power, 4e-6 off at most.
[[gnu::always_inline]] inline float sine_of_turns(float x) {
    const float a = 6.28318531f * x, b = a * a;
    return a * (1.0f + b * (-1.0f / 6 + b * (1.0f / 120 + b * (-1.0f / 5040 + b / 362880.0f))));
}

}  // namespace

EXITANCE_MULTIVERSION
void aim_hemisphere(RayPacket& rays, const Vec3f& origin, const Vec3f& normal, std::uint64_t key,
                    std::uint32_t packet) {
    const auto [first_u, first_v] = sobol(packet * static_cast<std::uint32_t>(width));
    const std::uint32_t shift_u = first_u ^ static_cast<std::uint32_t>(key);
    const std::uint32_t shift_v = first_v ^ static_cast<std::uint32_t>(key >> 32);
    const BasicFrame<float> frame(normal);
    const float ax = frame.tangent.x, ay = frame.tangent.y, az = frame.tangent.z;
    const float bx = frame.bitangent.x, by = frame.bitangent.y, bz = frame.bitangent.z;
    const float nx = normal.x, ny = normal.y, nz = normal.z;
    rays.origin_x.fill(origin.x), rays.origin_y.fill(origin.y), rays.origin_z.fill(origin.z);
    rays.near.fill(0.0f), rays.far.fill(std::numeric_limits<float>::infinity());
    rays.active = 0xffffu;
#pragma GCC unroll 1  // left to the vectoriser as a loop
    for (std::size_t k = 0; k < width; ++k) {
        const auto bits_u = static_cast<std::int32_t>((first_packet[0][k] ^ shift_u) >> 8);
        const auto bits_v = static_cast<std::int32_t>((first_packet[1][k] ^ shift_v) >> 8);
        const float u = static_cast<float>(bits_u) * 0x1.0p-24f;
        const float turn = static_cast<float>(bits_v) * 0x1.0p-24f - 0.5f;
        // sin is odd and symmetric about a quarter turn; cos is sin a quarter turn later.
        const float a = std::abs(turn);
        const float r = std::sqrt(u), up = std::sqrt(1.0f - u);
        const float x = r * sine_of_turns(0.25f - a);
        const float y = r * std::copysign(sine_of_turns(0.25f - std::abs(a - 0.25f)), turn);
        rays.direction_x[k] = x * ax + y * bx + up * nx;
        rays.direction_y[k] = x * ay + y * by + up * ny;
        rays.direction_z[k] = x * az + y * bz + up * nz;
    }
}

}  // namespace exitance
