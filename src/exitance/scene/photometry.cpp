// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/photometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace exitance {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double degree = pi / 180;

// Where x lies among increasing values, of which there are two at least and which bracket it.
struct Between {
    std::size_t index;
    double share;  // 0 at index, 1 at index + 1
};

Between find(const std::vector<double>& values, double x) {
    const auto above = std::upper_bound(values.begin() + 1, values.end() - 1, x);
    const auto i = static_cast<std::size_t>(above - values.begin()) - 1;
    return {i, (x - values[i]) / (values[i + 1] - values[i])};
}

// ∫ sin γ (linear from `first` at a to `last` at b) dγ over a … b [radians], in closed form; short
// ranges by Simpson's rule, where the closed form would cancel.
double integral_over_gamma(double a, double b, double first, double last) {
    const double h = b - a;
    if (h < 1e-3)
        return h / 6 *
               (first * std::sin(a) + 2 * (first + last) * std::sin((a + b) / 2) +
                last * std::sin(b));
    const double slope = (last - first) / h;
    // ∫ γ sin γ dγ = sin γ − γ cos γ.
    return (first - slope * a) * (std::cos(a) - std::cos(b)) +
           slope * (std::sin(b) - b * std::cos(b) - std::sin(a) + a * std::cos(a));
}

// Flux between planes i, i + 1 (all round if there is one plane) and gammas j, j + 1, up to the
// angle `most` [degrees]: the interpolant is linear in C, so the mean of its ends integrates it.
double cell_flux(const Photometry& p, std::size_t i, std::size_t j, double most = 180) {
    const std::size_t n = p.gammas.size(), next = p.planes.size() == 1 ? i : i + 1;
    const double width = p.planes.size() == 1 ? 2 * pi : (p.planes[next] - p.planes[i]) * degree;
    const double a = p.gammas[j], b = std::min(p.gammas[j + 1], most);
    if (b <= a) return 0;
    const auto mean = [&](std::size_t k) {
        return 0.5 * (p.candela[i * n + k] + p.candela[next * n + k]);
    };
    const double first = mean(j);
    const double last = first + (mean(j + 1) - first) * (b - a) / (p.gammas[j + 1] - p.gammas[j]);
    return width * integral_over_gamma(a * degree, b * degree, first, last);
}

std::size_t cells_round(const Photometry& p) {
    return std::max<std::size_t>(1, p.planes.size() - 1);
}

double flux_up_to(const Photometry& p, double most) {
    double sum = 0;
    for (std::size_t i = 0; i < cells_round(p); ++i)
        for (std::size_t j = 0; j + 1 < p.gammas.size(); ++j) sum += cell_flux(p, i, j, most);
    return sum;
}

}  // namespace

double LampTilt::factor(double degrees) const {
    if (angles.empty()) return 1;
    if (degrees <= angles.front()) return factors.front();
    if (degrees >= angles.back()) return factors.back();
    const auto [i, share] = find(angles, degrees);
    return factors[i] + share * (factors[i + 1] - factors[i]);
}

double Photometry::intensity(const Vec3& d) const {
    // atan2 keeps its accuracy near the poles, where acos loses half of the digits.
    const double gamma = std::atan2(std::sqrt(d.x * d.x + d.y * d.y), -d.z) / degree;
    return at(planes.size() == 1 ? 0.0 : std::atan2(d.y, d.x) / degree, gamma);
}

double Photometry::at(double c, double gamma) const {
    constexpr double rounding = 1e-9;  // of angles that come from directions
    if (gamma < gammas.front() - rounding || gamma > gammas.back() + rounding) return 0;
    const std::size_t n = gammas.size();
    const auto [j, down] = find(gammas, std::clamp(gamma, gammas.front(), gammas.back()));
    const auto in_plane = [&, at = j, share = down](std::size_t i) {
        const double first = candela[i * n + at];
        return first + share * (candela[i * n + at + 1] - first);
    };
    if (planes.size() == 1) return in_plane(0);
    const double wrapped = c - 360 * std::floor(c / 360);
    const auto [i, round] = find(planes, std::min(wrapped, 360.0));
    return (1 - round) * in_plane(i) + round * in_plane(i + 1);
}

double Photometry::flux() const {
    return flux_up_to(*this, 180);
}

double Photometry::flux_below() const {
    return flux_up_to(*this, 90);
}

DirectionSampler::DirectionSampler(const Photometry& photometry) : photometry_(&photometry) {
    double sum = 0;
    for (std::size_t i = 0; i < cells_round(photometry); ++i)
        for (std::size_t j = 0; j + 1 < photometry.gammas.size(); ++j)
            cumulative_.push_back(sum += cell_flux(photometry, i, j));
}

DirectionSampler::Sample DirectionSampler::sample(double cell, double u, double v) const {
    const Photometry& p = *photometry_;
    const double total = cumulative_.back();
    if (!(total > 0)) return {};
    const auto k = std::min<std::size_t>(
        static_cast<std::size_t>(
            std::upper_bound(cumulative_.begin(), cumulative_.end(), cell * total) -
            cumulative_.begin()),
        cumulative_.size() - 1);
    const std::size_t i = k / (p.gammas.size() - 1), j = k % (p.gammas.size() - 1);
    const double flux = cumulative_[k] - (k > 0 ? cumulative_[k - 1] : 0.0);
    if (!(flux > 0)) return {};
    // Evenly over the solid angle of the cell.
    const double top = std::cos(p.gammas[j] * degree), bottom = std::cos(p.gammas[j + 1] * degree);
    const double first = p.planes[i];
    const double width = p.planes.size() == 1 ? 360.0 : p.planes[i + 1] - first;
    const double cosine = top + v * (bottom - top), c = (first + u * width) * degree;
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    Sample out;
    out.direction = {sine * std::cos(c), sine * std::sin(c), -cosine};
    const double gamma = std::atan2(sine, cosine) / degree;
    out.weight = p.at(first + u * width, std::clamp(gamma, p.gammas[j], p.gammas[j + 1])) * width *
                 degree * (top - bottom) / flux;
    return out;
}

}  // namespace exitance
