// SPDX-License-Identifier: Apache-2.0
#include "polar_diagram.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "exitance/scene/lamp_figures.h"
#include "human_number.h"

namespace exitance::cli {

namespace {

constexpr double radius = 200;  // of the outermost ring, in user units
constexpr double margin = 40;
constexpr std::size_t steps = 720;
constexpr double degree = std::numbers::pi / 180;
constexpr const char* first_colour = "#c0392b";   // C0–C180
constexpr const char* second_colour = "#2257a8";  // C90–C270

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else
            out += c;
    }
    return out;
}

// 1, 2, 2.5 or 5 times a power of ten, so that four or five of them reach `peak`.
double ring_step(double peak) {
    const double ten = std::pow(10, std::floor(std::log10(peak / 5)));
    for (const double step : {1.0, 2.0, 2.5, 5.0})
        if (step * ten * 5 >= peak * (1 - 1e-9)) return step * ten;
    return 10 * ten;
}

class Diagram {
  public:
    Diagram(const Photometry& photometry, std::string title)
        : p_(photometry),
          title_(std::move(title)),
          figures_(figures_of(photometry)),
          relative_(p_.lamp_lumens && *p_.lamp_lumens > 0 && !p_.absolute),
          scale_(relative_ ? 1000 / *p_.lamp_lumens : 1) {
        curves_ = {profile(p_, 0, steps), profile(p_, 90, steps)};
        double peak = 0;
        for (std::vector<double>& curve : curves_)
            for (double& value : curve) peak = std::max(peak, value *= scale_);
        if (!(peak > 0)) peak = 1;
        step_ = ring_step(peak);
        rings_ = static_cast<int>(std::ceil(peak / step_ - 1e-9));
        largest_ = step_ * rings_;
        // A half without light is cut off where nothing would be seen of it.
        for (const std::vector<double>& curve : curves_)
            for (std::size_t i = 0; i <= steps; ++i) {
                const double t = angle(i);
                const double height = -std::cos(t) * curve[i] / largest_;
                up_ = std::max(up_, height), down_ = std::max(down_, -height);
            }
        up_ = up_ > 0.02 ? 1 : 0, down_ = down_ > 0.02 ? 1 : 0;
    }

    std::string svg() const {
        constexpr double header = 78, footer = 44, plain = 26;
        const double above = up_ > 0 ? radius + margin : plain;
        const double below = down_ > 0 ? radius + margin : plain;
        const double width = 2 * (radius + margin), height = header + above + below + footer;
        const double cx = width / 2, cy = header + above;
        std::string out = fmt::format(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
            "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"DejaVu Sans, Helvetica, Arial, "
            "sans-serif\" font-size=\"11\" fill=\"#222\">\n"
            "<title>{2}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
            width, height, escaped(title_));
        out += head(cx);
        out += fmt::format("<g transform=\"translate({:.0f} {:.0f})\">\n", cx, cy);
        out += grid() + labels() + curve(0) + curve(1) + "</g>\n";
        out += legend(cx, height - 18);
        return out + "</svg>\n";
    }

  private:
    static double angle(std::size_t i) {
        return (360 * static_cast<double>(i) / steps - 180) * degree;
    }

    std::string head(double cx) const {
        std::string name = title_;
        // By characters, not bytes.
        std::size_t cut = 0, shown = 0;
        while (cut < name.size() && shown < 58) {
            ++cut;
            while (cut < name.size() && (static_cast<unsigned char>(name[cut]) & 0xc0) == 0x80)
                ++cut;
            ++shown;
        }
        if (cut < name.size()) name = name.substr(0, cut) + "…";
        std::string facts = human_quantity(figures_.flux, "lm");
        if (figures_.efficacy) facts += ", " + human_quantity(*figures_.efficacy, "lm/W");
        facts += fmt::format(", peak {}", human_quantity(figures_.peak, "cd"));
        const std::string angles =
            fmt::format("beam {:.0f}° × {:.0f}°, field {:.0f}° × {:.0f}°", figures_.beam[0],
                        figures_.beam[1], figures_.field[0], figures_.field[1]);
        return fmt::format(
            "<g text-anchor=\"middle\"><text x=\"{0:.0f}\" y=\"26\" font-size=\"13\" "
            "font-weight=\"bold\">{1}</text>\n<text x=\"{0:.0f}\" y=\"46\">{2}</text>\n"
            "<text x=\"{0:.0f}\" y=\"62\">{3}</text></g>\n",
            cx, escaped(name), escaped(facts), escaped(angles));
    }

    // An arc of radius r over the halves that are shown.
    std::string arc(double r) const {
        if (up_ > 0 && down_ > 0) return fmt::format("<circle r=\"{:.2f}\"/>", r);
        return fmt::format("<path d=\"M {0:.2f} 0 A {0:.2f} {0:.2f} 0 0 {1} {2:.2f} 0\"/>", r,
                           down_ > 0 ? 1 : 0, -r);
    }

    bool shown(double degrees) const {
        return std::abs(std::cos(degrees * degree)) < 1e-9 ||
               (std::cos(degrees * degree) > 0 ? down_ : up_) > 0;
    }

    std::string grid() const {
        std::string out = "<g fill=\"none\" stroke=\"#c8c8c8\" stroke-width=\"0.8\">\n";
        for (int ring = 1; ring <= rings_; ++ring) out += arc(radius * ring / rings_) + "\n";
        for (int t = -180; t < 180; t += 15) {
            if (!shown(t)) continue;
            const double x = radius * std::sin(t * degree), y = radius * std::cos(t * degree);
            out += fmt::format("<line x2=\"{:.2f}\" y2=\"{:.2f}\"{}/>\n", x, y,
                               t % 30 == 0 ? "" : " stroke=\"#e4e4e4\"");
        }
        return out + "</g>\n";
    }

    std::string curve(std::size_t which) const {
        std::string d;
        for (std::size_t i = 0; i <= steps; ++i) {
            const double r = radius * curves_[which][i] / largest_, t = angle(i);
            d += fmt::format("{}{:.2f} {:.2f}", i == 0 ? "M" : " L", r * std::sin(t) + 0.0,
                             r * std::cos(t) + 0.0);
        }
        return fmt::format(
            "<path d=\"{}Z\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" "
            "stroke-linejoin=\"round\"{}/>\n",
            d, which == 0 ? first_colour : second_colour,
            which == 0 ? "" : " stroke-dasharray=\"7 4\"");
    }

    std::string labels() const {
        std::string out = "<g text-anchor=\"middle\" fill=\"#666\">\n";
        for (int t = -180; t < 180; t += 30) {
            if (!shown(t)) continue;
            const double r = radius + 18;
            out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}°</text>\n",
                               r * std::sin(t * degree), r * std::cos(t * degree) + 4, std::abs(t));
        }
        const double t = quietest();
        out +=
            "</g>\n<g text-anchor=\"middle\" fill=\"#444\" font-size=\"10\" "
            "paint-order=\"stroke\" stroke=\"#fff\" stroke-width=\"3\">\n";
        for (int ring = 1; ring <= rings_; ++ring) {
            const double r = radius * ring / rings_;
            out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", r * std::sin(t),
                               r * std::cos(t) + 3.5, human_number(step_ * ring));
        }
        return out + "</g>\n";
    }

    // Ring values stand between two spokes, where the curves are shortest.
    double quietest() const {
        double best = 0, least = 2;
        for (const double side : {22.5, 37.5, 52.5, 67.5})
            for (const double t : {side, -side}) {
                const double from_nadir = down_ > 0 ? t : 180 - t;
                const auto i = static_cast<std::size_t>(
                    std::lround((std::remainder(from_nadir, 360) + 180) / 360 * steps));
                const double longest = std::max(curves_[0][i], curves_[1][i]) / largest_;
                if (longest < least - 0.05) {
                    least = longest;
                    best = from_nadir * degree;
                }
            }
        return best;
    }

    std::string legend(double cx, double y) const {
        return fmt::format(
            "<g stroke-width=\"2\"><line x1=\"{0:.0f}\" x2=\"{1:.0f}\" y1=\"{6:.0f}\" "
            "y2=\"{6:.0f}\" stroke=\"{7}\"/><line x1=\"{2:.0f}\" x2=\"{3:.0f}\" y1=\"{6:.0f}\" "
            "y2=\"{6:.0f}\" stroke=\"{8}\" stroke-dasharray=\"7 4\"/></g>\n"
            "<text x=\"{4:.0f}\" y=\"{9:.0f}\">C180 – C0</text>"
            "<text x=\"{5:.0f}\" y=\"{9:.0f}\">C270 – C90</text>\n"
            "<text x=\"{10:.0f}\" y=\"{9:.0f}\" text-anchor=\"end\">{11}</text>\n",
            cx - 210, cx - 178, cx - 90, cx - 58, cx - 172, cx - 52, y - 4, first_colour,
            second_colour, y, cx + 220, relative_ ? "rings: cd/klm of the lamps" : "rings: cd");
    }

    const Photometry& p_;
    std::string title_;
    LampFigures figures_;
    bool relative_;
    double scale_;
    std::array<std::vector<double>, 2> curves_;
    double step_ = 1, largest_ = 1, up_ = 0, down_ = 0;
    int rings_ = 1;
};

}  // namespace

std::string polar_diagram(const Photometry& photometry, const std::string& title) {
    return Diagram(photometry, title).svg();
}

}  // namespace exitance::cli
