// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/c_planes.h"

#include <algorithm>
#include <cmath>

namespace exitance {

namespace {

double turned(double c) {
    const double once = std::fmod(c, 360.0);
    return once < 0 ? once + 360 : once;
}

void add_mirrored(std::vector<CPlane>& planes, double axis) {
    const std::size_t count = planes.size();
    for (std::size_t i = 0; i < count; ++i)
        planes.push_back({turned(2 * axis - planes[i].c), planes[i].candela});
}

}  // namespace

void set_planes(Photometry& photometry, std::vector<CPlane> planes, LampSymmetry symmetry) {
    if (planes.size() == 1 || symmetry == LampSymmetry::rotational) {
        photometry.planes = {0};
        photometry.candela = std::move(planes.front().candela);
        return;
    }
    for (CPlane& plane : planes) plane.c = turned(plane.c);
    if (symmetry == LampSymmetry::about_c0 || symmetry == LampSymmetry::both)
        add_mirrored(planes, 0);
    if (symmetry == LampSymmetry::about_c90 || symmetry == LampSymmetry::both)
        add_mirrored(planes, 90);
    std::stable_sort(planes.begin(), planes.end(),
                     [](const CPlane& a, const CPlane& b) { return a.c < b.c; });
    const auto same = [](const CPlane& a, const CPlane& b) { return b.c - a.c < 1e-6; };
    planes.erase(std::unique(planes.begin(), planes.end(), same), planes.end());
    // Where the circle is closed: between the last plane and the first one, C = 0 if there is one.
    const CPlane &first = planes.front(), &last = planes.back();
    std::vector<double> at_zero = first.candela;
    if (first.c > 0) {
        const double gap = first.c + 360 - last.c, share = (360 - last.c) / gap;
        for (std::size_t j = 0; j < at_zero.size(); ++j)
            at_zero[j] = last.candela[j] + share * (first.candela[j] - last.candela[j]);
        planes.insert(planes.begin(), {0, at_zero});
    }
    planes.push_back({360, std::move(at_zero)});
    photometry.planes.clear();
    photometry.candela.clear();
    for (const CPlane& plane : planes) {
        photometry.planes.push_back(plane.c);
        photometry.candela.insert(photometry.candela.end(), plane.candela.begin(),
                                  plane.candela.end());
    }
}

}  // namespace exitance
