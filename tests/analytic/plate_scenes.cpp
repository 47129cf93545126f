// SPDX-License-Identifier: Apache-2.0
#include "analytic/plate_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>

#include "analytic/configuration_factors.h"
#include "analytic/square_over_floor.h"
#include "exitance/math/polygon.h"
#include "scene/small_scenes.h"

namespace exitance::analytic {

namespace {

using testing::add_polygon;
using testing::add_square;
using testing::add_surface;

/// Two unit squares face to face, E and rho uniform on each.
struct Plates {
    double distance, E1, rho1, E2, rho2;
};

/// Irradiance of both plates at (x, y), by Nyström's method: the two integral equations on 12 × 12
/// Gauss points per plate, iterated until they stand still.
class PlatesExactly {
  public:
    explicit PlatesExactly(const Plates& plates) : plates_(plates) {
        make_rule();
        B1_.assign(nodes_.size(), plates.E1);
        B2_.assign(nodes_.size(), plates.E2);
        for (int sweep = 0; sweep < 60; ++sweep) {
            for (std::size_t i = 0; i < nodes_.size(); ++i)
                B2_[i] = plates.E2 + plates.rho2 * gather(nodes_[i].x, nodes_[i].y, B1_);
            for (std::size_t i = 0; i < nodes_.size(); ++i)
                B1_[i] = plates.E1 + plates.rho1 * gather(nodes_[i].x, nodes_[i].y, B2_);
        }
    }
    double on_first(double x, double y) const { return gather(x, y, B2_); }
    double on_second(double x, double y) const { return gather(x, y, B1_); }

  private:
    struct Node {
        double x, y, weight;
    };

    void make_rule() {
        constexpr int n = 12;
        std::array<double, n> abscissa, weight;
        for (int i = 0; i < n; ++i) {  // Newton's method on the Legendre polynomial P_n
            double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 0;
            for (int step = 0; step < 20; ++step) {
                double before = 1, P = x;
                for (int k = 2; k <= n; ++k) {
                    const double next = ((2 * k - 1) * x * P - (k - 1) * before) / k;
                    before = P, P = next;
                }
                slope = n * (x * P - before) / (x * x - 1);
                x -= P / slope;
            }
            abscissa[static_cast<std::size_t>(i)] = (x + 1) / 2;
            weight[static_cast<std::size_t>(i)] = 1 / ((1 - x * x) * slope * slope);
        }
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j)
                nodes_.push_back({abscissa[i], abscissa[j], weight[i] * weight[j]});
    }
    double gather(double x, double y, const std::vector<double>& B) const {
        const double h2 = plates_.distance * plates_.distance;
        double H = 0;
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const double dx = nodes_[i].x - x, dy = nodes_[i].y - y;
            const double r2 = dx * dx + dy * dy + h2;
            H += nodes_[i].weight * B[i] * h2 / (std::numbers::pi * r2 * r2);
        }
        return H;
    }

    Plates plates_;
    std::vector<Node> nodes_;
    std::vector<double> B1_, B2_;
};

Case two_plates() {
    // Form factor 1/3, as in the lectures' example (12.5217 and 2.0870 with one value per plate).
    const Plates plates{0.6399438604918362, 12, 0.75, 0, 0.5};
    const auto exactly = std::make_shared<PlatesExactly>(plates);
    Case c;
    c.name = "two_plates";
    const double h = plates.distance;
    add_square(c.scene, add_surface(c.scene, "ceiling", plates.rho1, plates.E1), 0, 0, h, 1, true);
    add_square(c.scene, add_surface(c.scene, "floor", plates.rho2, plates.E2), 0, 0, 0);
    c.exact = [exactly](const Vec3& at, const Vec3& normal) {
        return Spectrum(
            3, normal.z < 0 ? exactly->on_first(at.x, at.y) : exactly->on_second(at.x, at.y));
    };
    for (const auto& [x, y] : std::array<std::array<double, 2>, 5>{
             {{0.5, 0.5}, {0.25, 0.4}, {0.8, 0.9}, {0.5, 0.01}, {0.005, 0.995}}}) {
        c.add_probe({x, y, h}, {0, 0, -1});
        c.add_probe({x, y, 0}, {0, 0, 1});
    }
    c.why = "two coupled integral equations, solved to 1e-6 by Gauss quadrature";
    return c;
}

Case parallel_plates() {
    Case c;
    c.name = "parallel_plates";
    c.error = 0.005;  // the lamp is so near that its edge is nearly a step
    add_polygon(c.scene, add_surface(c.scene, "lamp", 0, 100),
                {{0, 0, 0.3}, {0, 1, 0.3}, {2, 1, 0.3}, {2, 0, 0.3}});
    add_polygon(c.scene, add_surface(c.scene, "floor", 0.5),
                {{-1, -1, 0}, {3, -1, 0}, {3, 2, 0}, {-1, 2, 0}});
    c.exact = [](const Vec3& at, const Vec3&) {
        return Spectrum(3, 100 * parallel_rectangle(-at.x, 2 - at.x, -at.y, 1 - at.y, 0.3));
    };
    for (const auto& [x, y] : std::array<std::array<double, 2>, 6>{
             {{1, 0.5}, {0, 0}, {1.9, 0.2}, {-0.4, 0.5}, {2.9, 1.9}, {1, 1.03}}})
        c.add_probe({x, y, 0}, {0, 0, 1});
    c.why = "a black lamp sends nothing back: 100 F of Howell B-3; 1 % for interpolation";
    return c;
}

Case perpendicular_plates() {
    Case c;
    c.name = "perpendicular_plates";
    add_polygon(c.scene, add_surface(c.scene, "wall", 0, 100),
                {{0, 0, 0}, {0, 2, 0}, {0, 2, 1}, {0, 0, 1}});
    add_polygon(c.scene, add_surface(c.scene, "floor", 0.7),
                {{0, 0, 0}, {1.5, 0, 0}, {1.5, 2, 0}, {0, 2, 0}});
    c.exact = [](const Vec3& at, const Vec3&) {
        return Spectrum(3, 100 * (perpendicular_rectangle(1, at.y, at.x) +
                                  perpendicular_rectangle(1, 2 - at.y, at.x)));
    };
    for (const auto& [x, y] : std::array<std::array<double, 2>, 6>{
             {{0.5, 1}, {0.1, 0.7}, {0.02, 1.5}, {0.05, 0.02}, {1.4, 1.9}, {1, 0.3}}})
        c.add_probe({x, y, 0}, {0, 0, 1});
    c.why =
        "a black lamp sends nothing back: 100 F of Howell B-4, which tends to 1/2 at the common "
        "edge; 1 % for interpolation";
    return c;
}

/// Irradiance of an unoccluded polygon of uniform exitance wholly above the horizon (Lambert 1760).
double lambert(const Vec3& point, const Vec3& normal, std::span<const Vec3> corners) {
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 a = normalized(corners[i] - point);
        const Vec3 b = normalized(corners[(i + 1) % corners.size()] - point);
        const double angle = std::atan2(length(cross(a, b)), dot(a, b));
        sum += angle * dot(normalized(cross(a, b)), normal);
    }
    return std::abs(sum) / (2 * std::numbers::pi);
}

Case tilted_lamp() {
    Case c;
    c.name = "tilted_lamp";
    const std::array<Vec3, 3> lamp{{{0.3, 0.2, 0.5}, {0.1, 0.8, 0.9}, {0.9, 0.4, 0.6}}};
    add_polygon(c.scene, add_surface(c.scene, "lamp", 0, 40), {lamp[0], lamp[1], lamp[2]});
    add_square(c.scene, add_surface(c.scene, "floor", 0.3), -1, -1, 0, 3);
    c.exact = [lamp](const Vec3& at, const Vec3& normal) {
        // The back is black.
        const bool lit = dot(unit_normal(lamp), at - lamp[0]) > 0;
        return Spectrum(3, lit ? 40 * lambert(at, normal, lamp) : 0.0);
    };
    for (const auto& [x, y] : std::array<std::array<double, 2>, 5>{
             {{0.4, 0.4}, {0.1, 0.1}, {0.6, -0.5}, {1.2, 0.6}, {-0.8, -0.8}}})
        c.add_probe({x, y, 0}, {0, 0, 1});
    c.why =
        "a triangle of uniform exitance above a floor: Lambert's formula; 1 % for interpolation";
    return c;
}

Case occluded_square() {
    Case c;
    c.name = "occluded_square";
    add_square(c.scene, add_surface(c.scene, "lamp", 0, 100), -1, -1, 2, 2, true);
    add_black_square(c.scene);
    add_square(c.scene, add_surface(c.scene, "floor", 0.5), -3, -3, 0, 6);
    c.exact = square_under_a_panel();
    for (const auto& [x, y] : std::array<std::array<double, 2>, 7>{
             {{0, 0}, {0.3, 0.1}, {0.7, 0}, {1.2, 0.9}, {1.7, 0.2}, {2.4, 2.4}, {-1, 0.5}}})
        c.add_probe({x, y, 0}, {0, 0, 1});
    c.tolerance = 0.02;
    c.why =
        "lamp minus the part that the square hides, both Howell B-3; 2 % for interpolation across "
        "the penumbra";
    return c;
}

}  // namespace

std::vector<Case> plate_cases() {
    return {two_plates(), parallel_plates(), perpendicular_plates(), tilted_lamp(),
            occluded_square()};
}

}  // namespace exitance::analytic
