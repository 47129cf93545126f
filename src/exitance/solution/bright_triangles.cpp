// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/bright_triangles.h"

#include <algorithm>

#include "exitance/math/warp.h"
#include "exitance/run/parallel.h"

namespace exitance {

namespace {

constexpr double bright = 8, worth_it = 0.2;

}  // namespace

BrightTriangles::BrightTriangles(const Surfaces& surfaces) : surfaces_(surfaces) {
    const Solution& solution = surfaces.solution();
    const std::size_t count = solution.triangles.size();
    std::vector<double> level(count), area(count);
    parallel_for(
        count,
        [&](std::size_t t) {
            const SurfacePlace middle{static_cast<std::uint32_t>(t), {1.0 / 3, 1.0 / 3, 1.0 / 3}};
            std::vector<double> H(solution.columns());
            Surfaces::PatternHere room;
            surfaces.irradiance(middle, H);
            const auto rho = surfaces.reflectance(middle, room);
            for (std::size_t c = 0; c < H.size(); ++c) H[c] *= rho[c % rho.size()];
            level[t] = std::max(0.0, solution.luminance(H));
            const auto [a, b, c] = surfaces.corners(middle.triangle);
            area[t] = 0.5 * length(cross(b - a, c - a));
        },
        1024);
    double all = 0, sum = 0, square = 0;
    for (std::size_t t = 0; t < count; ++t)
        all += area[t], sum += area[t] * level[t], square += area[t] * level[t] * level[t];
    if (!(sum > 0)) return;
    const double least = bright * sum / all;
    double of_bright = 0, total = 0;
    for (std::size_t t = 0; t < count; ++t) {
        if (!(level[t] >= least) || !(area[t] > 0)) continue;
        of_bright += area[t] * level[t] * level[t];
        triangles_.push_back(static_cast<std::uint32_t>(t));
        cumulative_.push_back(total += area[t] * level[t]);
    }
    if (of_bright < worth_it * square) {
        triangles_.clear(), cumulative_.clear();
        return;
    }
    density_.assign(count, 0.0f);
    for (const std::uint32_t t : triangles_) density_[t] = static_cast<float>(level[t] / total);
}

BrightTriangles::Sample BrightTriangles::sample(double pick, double u, double v) const {
    const auto above =
        std::upper_bound(cumulative_.begin(), cumulative_.end(), pick * cumulative_.back());
    const auto nth =
        std::min(static_cast<std::size_t>(above - cumulative_.begin()), triangles_.size() - 1);
    const auto w = uniform_triangle({u, v});
    Sample out;
    out.at = {triangles_[nth], {w[0], w[1], w[2]}};
    const auto [a, b, c] = surfaces_.corners(out.at.triangle);
    out.place = a * w[0] + b * w[1] + c * w[2];
    out.normal = normalized(cross(b - a, c - a));
    out.density = density(out.at.triangle);
    return out;
}

}  // namespace exitance
