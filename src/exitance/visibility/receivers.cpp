// SPDX-License-Identifier: Apache-2.0
#include "exitance/visibility/receivers.h"

#include <algorithm>

#include "exitance/math/polygon.h"

namespace exitance {

Source::Source(const std::array<Vec3, 4>& points, std::uint32_t n, const Vec3& middle) : count(n) {
    const Vec3 a = vector_area({points.data(), n});
    normal = Vec3f(normalized(a));
    area = static_cast<float>(length(a));
    // A triangle repeats its last corner, so that loops over four corners serve both.
    for (std::uint32_t i = 0; i < 4; ++i) corners[i] = Vec3f(points[std::min(i, n - 1)] - middle);
}

void ReceiverBlock::load(const Receivers& all, const std::uint32_t* which, std::size_t n) {
    size = n;
    const std::size_t padded = (n + 15) / 16 * 16;
    // Blocks are mostly runs of consecutive receivers.
    if (n == capacity && which[n - 1] - which[0] == n - 1) {
        const std::size_t first = which[0];
        std::copy_n(&all.x[first], n, x.data());
        std::copy_n(&all.y[first], n, y.data());
        std::copy_n(&all.z[first], n, z.data());
        std::copy_n(&all.nx[first], n, nx.data());
        std::copy_n(&all.ny[first], n, ny.data());
        std::copy_n(&all.nz[first], n, nz.data());
        std::copy_n(&all.key[first], n, key.data());
        return;
    }
    for (std::size_t i = 0; i < padded; ++i) {
        const std::uint32_t r = which[std::min(i, n - 1)];
        x[i] = all.x[r], y[i] = all.y[r], z[i] = all.z[r];
        nx[i] = all.nx[r], ny[i] = all.ny[r], nz[i] = all.nz[r];
        key[i] = all.key[r];
    }
}

}  // namespace exitance
