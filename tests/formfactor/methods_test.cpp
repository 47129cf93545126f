// SPDX-License-Identifier: Apache-2.0
// Every method meets every closed form that it can take, within the accuracy it was asked for.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "enclosures.h"
#include "exitance/formfactor/closure.h"
#include "exitance/formfactor/polygon_polygon.h"
#include "exitance/run/error.h"
#include "view_factor_cases.h"

namespace exitance {
namespace {

using enclosures::add;
using enclosures::add_box;
using enclosures::add_rectangle;
using enclosures::compute;
using enclosures::dense;

const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

// Sampling errors are normal: four standard errors happen once in 16000 factors. Where a method's
// error is not: discs have no corners, a hemicube sees from the middles of at most 64 cells.
struct Case {
    std::string name;
    Enclosure enclosure;
    std::uint32_t from, to;
    double F;
    bool touching;                    // facets meet at an edge
    bool too_near_for_discs = false;  // sixteen discs along the larger facet are wider than the gap
};

std::vector<Case> cases() {
    std::vector<Case> out;
    const auto pair = [&](const std::string& name, double F, bool touching, const Vec3& corner1,
                          const Vec3& u1, const Vec3& v1, const Vec3& corner2, const Vec3& u2,
                          const Vec3& v2) {
        Enclosure e;
        add_rectangle(e, corner1, u1, v1, 0);
        add_rectangle(e, corner2, u2, v2, 1);
        out.push_back({name, std::move(e), 0, 1, F, touching});
    };
    using view_factors::parallel, view_factors::perpendicular;
    pair("facing squares", parallel(1, 1, 1), false, {}, x, y, z, y, x);
    pair("facing squares, far", parallel(1, 1, 10), false, {}, x, y, z * 10, y, x);
    pair("facing rectangles", parallel(2, 1, 0.5), false, {}, x * 2, y, z * 0.5, y, x * 2);
    pair("squares at an edge", perpendicular(1, 1, 1), true, {}, x, y, {}, y, z);
    pair("rectangles at an edge", perpendicular(2, 1, 0.5), true, {}, x, y * 2, {}, y * 2, z * 0.5);
    {
        // Partly below the horizon of the first: what is above is the wall at an edge.
        Enclosure e;
        add_rectangle(e, {}, x, y, 0);
        add_rectangle(e, z * -1, y, z * 2, 1);
        out.push_back(
            {"a wall through the floor's plane", std::move(e), 0, 1, perpendicular(1, 1, 1), true});
    }
    {
        // A convex body in a box: F(box → body) = A_body / A_box by symmetry.
        Enclosure e;
        add_box(e, {}, 1, true, 0);
        Enclosure inner;
        add_box(inner, {0.3, 0.3, 0.3}, 0.4, false, 0);
        for (Facet facet : inner.facets) {
            facet.row = 6;
            e.facets.push_back(facet);
        }
        e.surfaces.push_back({"body", 6 * 0.16, 1});
        out.push_back({"a body in a box", e, 0, 6, 0.16, false});
        out.push_back({"a box round a body", std::move(e), 6, 2, 1.0 / 6, false});
    }
    {
        // A low wall on a large floor, of which a sheet leaves it a strip to see: a few rays that
        // are spread evenly over the floor would all be blocked.
        Enclosure e;
        add_rectangle(e, {4, 4, 0}, y * 0.1, z * 0.1, 0);
        add_rectangle(e, {}, x * 8, y * 8, 1);
        add_rectangle(e, {4.5, -1, -1}, y * 10, z * 3, Facet::only_blocks);
        const std::array wall{Vec3{4, 4, 0}, Vec3{4, 4.1, 0}, Vec3{4, 4.1, 0.1}, Vec3{4, 4, 0.1}};
        const std::array strip{Vec3{4, 0, 0}, Vec3{4.5, 0, 0}, Vec3{4.5, 8, 0}, Vec3{4, 8, 0}};
        out.push_back({"a low wall at a hidden floor", std::move(e), 0, 1,
                       exchange_area(wall, strip) / 0.01, true, true});
    }
    {
        Enclosure e;
        add_rectangle(e, {}, x, y, 0);
        add_rectangle(e, z, y, x, 1);
        add_rectangle(e, Vec3{-1, -1, 0.5}, x * 3, y * 3, Facet::only_blocks);
        out.push_back({"a wall between", std::move(e), 0, 1, 0, false});
    }
    return out;
}

double allowed(const std::string& method, const Case& c, double accuracy) {
    if (method == "auto") return accuracy;
    if (method == "disk") return c.touching ? 0.02 : 4 * accuracy;
    if (method == "hemicube") return 4 * accuracy;
    return 4 * accuracy;
}

TEST(FormFactorMethods, MeetClosedForms) {
    MethodOptions options;
    options.accuracy = 1e-3;
    for (const FormFactorMethod& method : form_factor_methods())
        for (const Case& c : cases()) {
            if (c.too_near_for_discs && method.name == std::string("disk")) continue;
            const auto F = dense(compute(c.enclosure, method.name, options));
            EXPECT_NEAR(F[c.from][c.to], c.F, allowed(method.name, c, options.accuracy))
                << method.name << ", " << c.name;
            // Seen from the other side: errors grow with the ratio of areas.
            const double ratio =
                c.enclosure.surfaces[c.from].area / c.enclosure.surfaces[c.to].area;
            EXPECT_NEAR(F[c.to][c.from], c.F * ratio,
                        allowed(method.name, c, options.accuracy) * std::max(1.0, ratio))
                << method.name << ", " << c.name;
        }
}

TEST(FormFactorMethods, CloseAnEmptyCube) {
    Enclosure cube;
    add_box(cube, {}, 1, true, 0, 2, false);
    MethodOptions options;
    options.accuracy = 2e-3;
    for (const FormFactorMethod& method : form_factor_methods()) {
        const MatrixQuality q = quality(compute(cube, method.name, options));
        // Rays and hemicubes lose nothing. The others add up 20 factors, each within the accuracy.
        const std::string name = method.name;
        const bool complete = name == "hemicube" || name == "hemisphere";
        const double wrong = complete ? 1e-5 : 20 * options.accuracy;
        EXPECT_NEAR(q.least_sum, 1, wrong) << name;
        EXPECT_NEAR(q.most_sum, 1, wrong) << name;
    }
}

TEST(FormFactorMethods, DoNotDependOnTheNumberOfThreads) {
    Enclosure e;
    add_box(e, {}, 1, true, 0, 2, false);
    add_box(e, {0.3, 0.3, 0.3}, 0.4, false, 24);
    MethodOptions options;
    options.accuracy = 0.01;
    for (const FormFactorMethod& method : form_factor_methods()) {
        const auto many = dense(compute(e, method.name, options));
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        EXPECT_EQ(many, dense(compute(e, method.name, options))) << method.name;
    }
}

TEST(FormFactorMethods, SeeBothSidesOfATwoSidedPolygon) {
    // A plate between two others: its front sees one, its back the other.
    Enclosure e;
    add_rectangle(e, {}, x, y, 0);
    add_rectangle(e, z * 2, y, x, 1);
    add_rectangle(e, z, x, y, 2);
    add_rectangle(e, z, y, x, 3);
    MethodOptions options;
    options.accuracy = 2e-3;
    const double F = view_factors::parallel(1, 1, 1);
    for (const FormFactorMethod& method : form_factor_methods()) {
        const auto found = dense(compute(e, method.name, options));
        EXPECT_NEAR(found[0][3], F, 4 * options.accuracy) << method.name;
        EXPECT_NEAR(found[2][1], F, 4 * options.accuracy) << method.name;
        EXPECT_EQ(found[0][2], 0) << method.name;
        EXPECT_EQ(found[2][3], 0) << method.name;
        // The plate hides all but a rim of the one behind.
        EXPECT_LT(found[0][1], 0.3 * view_factors::parallel(1, 1, 2)) << method.name;
    }
}

TEST(FormFactorMethods, AFixedEffortIsKept) {
    Enclosure e;
    add_rectangle(e, {}, x, y, 0);
    add_rectangle(e, z, y, x, 1);
    MethodOptions options;
    options.samples = 64;
    MethodCounters counters;
    const Observer nobody;
    find_form_factor_method("hemisphere").compute({e, options, nobody, nullptr, counters});
    EXPECT_EQ(counters.rays, 2 * 64U);
    counters.rays = 0;
    find_form_factor_method("monte-carlo").compute({e, options, nobody, nullptr, counters});
    EXPECT_EQ(counters.rays, 64U);
}

TEST(FormFactorMethods, AnUnknownOneIsRefusedWithASuggestion) {
    try {
        find_form_factor_method("hemicub");
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(),
                     "unknown form factor method 'hemicub', did you mean 'hemicube'?");
    }
}

TEST(FormFactorMethods, StopWhenAsked) {
    Enclosure cube;
    add_box(cube, {}, 1, true, 0, 4, false);
    Cancel cancel;
    MethodOptions options;
    std::size_t reports = 0;
    const Observer observe = [&](const Progress& progress) {
        ++reports;
        EXPECT_TRUE(progress.even);
        cancel.request();
    };
    for (const FormFactorMethod& method : form_factor_methods()) {
        MethodCounters counters;
        reports = 0;
        try {
            method.compute({cube, options, observe, &cancel, counters});
        } catch (const Error& error) {
            EXPECT_EQ(error.fault(), Fault::could_not_finish);
        }
        EXPECT_LT(reports, 20U) << method.name;
    }
}

}  // namespace
}  // namespace exitance
