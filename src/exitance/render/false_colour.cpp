// SPDX-License-Identifier: Apache-2.0
#include "exitance/render/false_colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "exitance/render/canvas.h"

namespace exitance {

namespace {

/// Linear RGB of Oklab lightness, chroma and hue (Ottosson 2020, "A perceptual color space for
/// image processing").
Vec3 rgb_of_oklab(double L, double chroma, double hue) {
    const double a = chroma * std::cos(hue), b = chroma * std::sin(hue);
    const auto cube = [](double v) { return v * v * v; };
    const double l = cube(L + 0.3963377774 * a + 0.2158037573 * b);
    const double m = cube(L - 0.1055613458 * a - 0.0638541728 * b);
    const double s = cube(L - 0.0894841775 * a - 1.2914855480 * b);
    return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
            -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
            -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

/// "1500", "0.25", "2e-05": as short as the step between marks allows.
std::string mark_text(double value, double step) {
    const double magnitude = std::max(std::abs(value), step);
    if (magnitude >= 1e6 || magnitude < 1e-4) return fmt::format("{:g}", value);
    const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
    return fmt::format("{:.{}f}", value, std::min(decimals, 8));
}

double round_step(double span, int count) {
    const double raw = span / std::max(1, count);
    const double power = std::pow(10, std::floor(std::log10(raw)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= raw * 0.999) return factor * power;
    return 10 * power;
}

}  // namespace

Vec3f false_colour(double t) {
    t = std::clamp(t, 0.0, 1.0);
    const double L = 0.25 + 0.68 * t;
    const double hue = (300 - 195 * t) * std::numbers::pi / 180;
    // Just inside what a screen can show along this path, without kinks that would look like edges.
    const double chroma = 0.094 + 0.2 * (t - 0.42) * (t - 0.42);
    return Vec3f(rgb_of_oklab(L, chroma, hue));
}

std::vector<double> round_marks(double low, double high, int count) {
    if (!(high > low)) return {low};
    const double step = round_step(high - low, count);
    std::vector<double> out;
    for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k)
        out.push_back(k * step + 0.0);  // + 0: no "-0"
    return out;
}

void draw_legend(Image& image, double low, double high, const std::string& title,
                 const std::string& unit) {
    const double width = image.width, height = image.height;
    const double size = std::clamp(std::min(width, height) / 34, 9.0, 60.0);
    const double gap = 0.6 * size;
    const Vec3f ink{0.85f, 0.85f, 0.85f}, paper{0.012f, 0.012f, 0.014f};

    const double bar_height = std::min(height - 2 * gap - 4.2 * size, 0.72 * height);
    const int count = std::clamp(static_cast<int>(bar_height / (2.4 * size)), 2, 8);
    const std::vector<double> marks = round_marks(low, high, count);
    const double step = marks.size() > 1 ? marks[1] - marks[0] : std::max(std::abs(low), 1.0);
    double label_width = 0;
    for (const double mark : marks)
        label_width = std::max(label_width, Canvas::text_width(mark_text(mark, step), size));
    const double bar_width = 1.5 * size;
    const double scale_width = bar_width + 0.9 * size + label_width;
    const double panel_width =
        2 * gap + std::max({scale_width, Canvas::text_width(title, size),
                            unit.empty() ? 0.0 : Canvas::text_width(unit, size)});
    // A picture too small to carry one goes without.
    if (bar_height < 2 * size || panel_width > 0.6 * width) return;
    const double left = width - panel_width, panel_height = bar_height + 2 * gap + 3.4 * size;
    const double top = 0.5 * (height - panel_height);

    Canvas canvas(image);
    canvas.fill(std::floor(left), std::floor(top), width, std::ceil(top + panel_height), paper,
                0.85);
    canvas.text(left + gap, top + gap + 0.8 * size, size, title, ink);
    if (!unit.empty()) canvas.text(left + gap, top + gap + 2.0 * size, size, unit, ink);

    const double bar_left = std::round(left + gap), bar_top = std::round(top + gap + 2.9 * size);
    const double bar_bottom = std::round(bar_top + bar_height);
    for (double y = bar_top; y < bar_bottom; ++y)
        canvas.fill(bar_left, y, bar_left + bar_width, y + 1,
                    false_colour((bar_bottom - y - 0.5) / (bar_bottom - bar_top)));
    for (const double mark : marks) {
        const double t = high > low ? (mark - low) / (high - low) : 0.5;
        const double y = bar_bottom - t * (bar_bottom - bar_top);
        const double thick = std::max(1.0, size / 14);
        canvas.fill(bar_left + bar_width, y - 0.5 * thick, bar_left + bar_width + 0.4 * size,
                    y + 0.5 * thick, ink);
        canvas.text(bar_left + bar_width + 0.7 * size,
                    std::round(y + 0.5 * Canvas::digit_height(size)), size, mark_text(mark, step),
                    ink);
    }
}

}  // namespace exitance
