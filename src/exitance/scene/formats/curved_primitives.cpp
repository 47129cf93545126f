// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/curved_primitives.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exitance/math/frame.h"
#include "exitance/math/polygon.h"

namespace exitance {

namespace {

constexpr double pi = std::numbers::pi;
constexpr std::uint32_t none = Polygon::none;

// Directions around an axis. An axis and its opposite have the same ones, so that a disc closes
// a cylinder from both ends without gaps.
class Circle {
  public:
    Circle(const Vec3& unit_axis, std::uint32_t facets) : facets_(facets) {
        // The first component that is clearly there is made positive.
        Vec3 axis = unit_axis;
        for (std::size_t i = 0; i < 3; ++i)
            if (std::abs(axis[i]) > 1e-6) {
                if (axis[i] < 0) axis = -axis, reversed_ = true;
                break;
            }
        const Frame frame(axis);
        for (std::uint32_t i = 0; i < facets; ++i) {
            const double angle = 2 * pi * i / facets;
            directions_.push_back(frame.tangent * std::cos(angle) +
                                  frame.bitangent * std::sin(angle));
        }
    }

    /// Direction i counter-clockwise around the axis given.
    const Vec3& operator[](std::uint32_t i) const {
        return directions_[(reversed_ ? facets_ - i % facets_ : i) % facets_];
    }

  private:
    std::uint32_t facets_;
    bool reversed_ = false;
    std::vector<Vec3> directions_;
};

}  // namespace

double Facets::area() const {
    double sum = 0;
    for (const auto& polygon : polygons) {
        const std::size_t n = polygon[3] == none ? 3 : 4;
        std::array<Vec3, 4> c;
        for (std::size_t i = 0; i < n; ++i) c[i] = points[polygon[i]];
        sum += exitance::area({c.data(), n});
    }
    return sum;
}

void Facets::turn_round() {
    for (auto& polygon : polygons)
        std::reverse(polygon.begin(), polygon.begin() + (polygon[3] == none ? 3 : 4));
    for (Vec3& normal : normals) normal = -normal;
}

std::uint32_t facets_per_turn(double tolerance) {
    const double needed = pi / std::acos(1 - std::clamp(tolerance, 1e-6, 0.5));
    return std::max(8U, 4 * static_cast<std::uint32_t>(std::ceil(needed / 4 - 1e-9)));
}

std::uint64_t sphere_facet_count(std::uint32_t facets) {
    return std::uint64_t{facets} * (facets / 2);
}

Facets sphere_facets(const Vec3& centre, double radius, std::uint32_t facets) {
    const Circle circle({0, 0, 1}, facets);
    const std::uint32_t rows = facets / 2;
    Facets out;
    const auto add = [&](const Vec3& direction) {
        out.points.push_back(centre + direction * radius);
        out.normals.push_back(direction);
    };
    add({0, 0, 1});
    for (std::uint32_t r = 1; r < rows; ++r) {
        const double theta = pi * r / rows;
        for (std::uint32_t i = 0; i < facets; ++i)
            add(circle[i] * std::sin(theta) + Vec3{0, 0, std::cos(theta)});
    }
    add({0, 0, -1});
    const std::uint32_t south = 1 + (rows - 1) * facets;
    const auto at = [&](std::uint32_t r, std::uint32_t i) {
        return 1 + (r - 1) * facets + i % facets;
    };
    for (std::uint32_t i = 0; i < facets; ++i) {
        out.polygons.push_back({0, at(1, i), at(1, i + 1), none});
        for (std::uint32_t r = 1; r + 1 < rows; ++r)
            out.polygons.push_back({at(r, i), at(r + 1, i), at(r + 1, i + 1), at(r, i + 1)});
        out.polygons.push_back({at(rows - 1, i), south, at(rows - 1, i + 1), none});
    }
    out.true_area = 4 * pi * radius * radius;
    return out;
}

Facets frustum_facets(const Vec3& from, double from_radius, const Vec3& to, double to_radius,
                      std::uint32_t facets) {
    const Vec3 along = to - from;
    const double height = length(along);
    const Vec3 axis = along / height;
    const Circle circle(axis, facets);
    const double slant = std::hypot(height, to_radius - from_radius);
    Facets out;
    for (std::uint32_t i = 0; i < facets; ++i) {
        // Perpendicular to the slope: radius shrinks by (r0 − r1) over the height.
        const Vec3 normal = normalized(circle[i] * height + axis * (from_radius - to_radius));
        out.points.push_back(from + circle[i] * from_radius);
        out.points.push_back(to + circle[i] * to_radius);
        out.normals.push_back(normal);
        out.normals.push_back(normal);
    }
    for (std::uint32_t i = 0; i < facets; ++i) {
        const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % facets);
        if (from_radius == 0)
            out.polygons.push_back({a, b + 1, a + 1, none});
        else if (to_radius == 0)
            out.polygons.push_back({a, b, a + 1, none});
        else
            out.polygons.push_back({a, b, b + 1, a + 1});
    }
    out.true_area = pi * (from_radius + to_radius) * slant;
    return out;
}

Facets ring_facets(const Vec3& centre, const Vec3& normal, double inner, double outer,
                   std::uint32_t facets) {
    const Circle circle(normal, facets);
    Facets out;
    const auto add = [&](const Vec3& point) {
        out.points.push_back(point);
        out.normals.push_back({});
    };
    if (inner == 0) add(centre);
    for (std::uint32_t i = 0; i < facets; ++i) {
        add(centre + circle[i] * outer);
        if (inner > 0) add(centre + circle[i] * inner);
    }
    for (std::uint32_t i = 0; i < facets; ++i) {
        const std::uint32_t j = (i + 1) % facets;
        if (inner == 0)
            out.polygons.push_back({0, 1 + i, 1 + j, none});
        else
            out.polygons.push_back({2 * i, 2 * j, 2 * j + 1, 2 * i + 1});
    }
    out.true_area = pi * (outer * outer - inner * inner);
    return out;
}

Facets torus_facets(const Vec3& centre, const Vec3& axis, double inner, double outer,
                    std::uint32_t facets) {
    const Circle circle(axis, facets);
    const double middle = (inner + outer) / 2, tube = (outer - inner) / 2;
    Facets out;
    for (std::uint32_t i = 0; i < facets; ++i)
        for (std::uint32_t j = 0; j < facets; ++j) {
            const double angle = 2 * pi * j / facets;
            const Vec3 normal = circle[i] * std::cos(angle) + axis * std::sin(angle);
            out.points.push_back(centre + circle[i] * middle + normal * tube);
            out.normals.push_back(normal);
        }
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
        return (i % facets) * facets + j % facets;
    };
    for (std::uint32_t i = 0; i < facets; ++i)
        for (std::uint32_t j = 0; j < facets; ++j)
            out.polygons.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    out.true_area = 4 * pi * pi * middle * tube;
    return out;
}

}  // namespace exitance
