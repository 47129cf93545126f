// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/luminous_opening.h"

#include <cmath>
#include <numbers>

#include "exitance/math/polygon.h"

namespace exitance {

namespace {

constexpr std::size_t sectors = 16;
constexpr std::size_t bands = 8;  // of latitude on an ellipsoid

class Body {
  public:
    // A polygon by its corners, counter-clockwise seen from outside; nothing if it has no area.
    void add(const std::vector<Vec3>& corners) {
        OpeningFacet facet;
        facet.count = static_cast<std::uint32_t>(corners.size());
        for (std::size_t i = 0; i < corners.size(); ++i) facet.corners[i] = corners[i];
        facet.area = area(corners);
        if (!(facet.area > 0)) return;
        facet.normal = unit_normal(corners);
        facets.push_back(facet);
    }

    std::vector<OpeningFacet> facets;
};

// The bottom at z = −h/2, the top at +h/2; sides stand on the bottom.
std::vector<OpeningFacet> box(const LuminousOpening& opening) {
    const double x = opening.size.x / 2, y = opening.size.y / 2, z = opening.size.z / 2;
    const auto height = [&](std::size_t side) {
        return opening.sides_shine ? z : opening.sides[side] - z;
    };
    Body body;
    body.add({{-x, -y, -z}, {-x, y, -z}, {x, y, -z}, {x, -y, -z}});
    body.add({{-x, -y, z}, {x, -y, z}, {x, y, z}, {-x, y, z}});
    body.add({{x, -y, -z}, {x, y, -z}, {x, y, height(0)}, {x, -y, height(0)}});
    body.add({{x, y, -z}, {-x, y, -z}, {-x, y, height(1)}, {x, y, height(1)}});
    body.add({{-x, y, -z}, {-x, -y, -z}, {-x, -y, height(2)}, {-x, y, height(2)}});
    body.add({{-x, -y, -z}, {x, -y, -z}, {x, -y, height(3)}, {-x, -y, height(3)}});
    return body.facets;
}

// A regular polygon of the area of the circle: n/2 R² sin(2π/n) = π r².
double rim() {
    const double step = 2 * std::numbers::pi / sectors;
    return std::sqrt(step / std::sin(step));
}

std::vector<OpeningFacet> cylinder(const LuminousOpening& opening) {
    // Upright first, then x, y, z cycle until z is along the axis.
    const std::size_t a = opening.axis, b = (a + 1) % 3, c = (a + 2) % 3;
    const auto place = [&](double along_b, double along_c, double along) {
        Vec3 p;
        p[a] = along * opening.size[a] / 2;
        p[b] = along_b * opening.size[b] / 2;
        p[c] = along_c * opening.size[c] / 2;
        return p;
    };
    Body body;
    const double r = rim();
    for (std::size_t s = 0; s < sectors; ++s) {
        const double step = 2 * std::numbers::pi / sectors;
        const double t0 = step * static_cast<double>(s), t1 = t0 + step;
        const double x0 = r * std::cos(t0), y0 = r * std::sin(t0), x1 = r * std::cos(t1),
                     y1 = r * std::sin(t1);
        body.add({place(0, 0, 1), place(x0, y0, 1), place(x1, y1, 1)});
        body.add({place(0, 0, -1), place(x1, y1, -1), place(x0, y0, -1)});
        if (opening.sides_shine)
            body.add({place(x0, y0, -1), place(x1, y1, -1), place(x1, y1, 1), place(x0, y0, 1)});
    }
    return body.facets;
}

std::vector<OpeningFacet> ellipsoid(const LuminousOpening& opening) {
    Body body;
    const auto place = [&](std::size_t band, std::size_t sector) {
        const double theta = std::numbers::pi * static_cast<double>(band) / bands;
        const double phi = 2 * std::numbers::pi * static_cast<double>(sector % sectors) / sectors;
        return Vec3{std::sin(theta) * std::cos(phi) * opening.size.x / 2,
                    std::sin(theta) * std::sin(phi) * opening.size.y / 2,
                    std::cos(theta) * opening.size.z / 2};
    };
    for (std::size_t band = 0; band < bands; ++band)
        for (std::size_t s = 0; s < sectors; ++s) {
            if (band == 0)
                body.add({place(0, s), place(1, s), place(1, s + 1)});
            else if (band + 1 == bands)
                body.add({place(band, s), place(bands, s), place(band, s + 1)});
            else
                body.add({place(band, s), place(band + 1, s), place(band + 1, s + 1),
                          place(band, s + 1)});
        }
    return body.facets;
}

}  // namespace

std::vector<OpeningFacet> facets(const LuminousOpening& opening) {
    switch (opening.shape) {
        case LuminousOpening::Shape::point:
            return {};
        case LuminousOpening::Shape::box:
            return box(opening);
        case LuminousOpening::Shape::cylinder:
            return cylinder(opening);
        case LuminousOpening::Shape::ellipsoid:
            return ellipsoid(opening);
    }
    return {};
}

}  // namespace exitance
