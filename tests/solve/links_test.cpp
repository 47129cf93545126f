// SPDX-License-Identifier: Apache-2.0
// Links between nodes of the hierarchy: what they carry, how many there are, and when they end.
#include <gtest/gtest.h>

#include <cmath>

#include "exitance/run/random.h"
#include "exitance/scene/groups.h"
#include "exitance/solve/link_refinement.h"
#include "exitance/transport/element_caster.h"
#include "solve/solve_scenes.h"
#include "truth/cornell_box.h"

namespace exitance {
namespace {

// A closed room all of whose surfaces emit the same, with a block on its floor.
struct Room {
    Scene scene = made();
    Radiosity radiosity;
    ElementScene elements{radiosity.mesh, radiosity.caster, radiosity.owners,
                          radiosity.two_sided()};
    LinkRefinement links;

    explicit Room(double patch, LinkOptions options = {})
        : radiosity(scene, make_groups(scene, Grouping::none), MeshOptions::of_patches(patch)),
          links(radiosity, elements, options) {}

    static Scene made() {
        Scene room;
        solve_scenes::add_room(room, {}, {3, 2, 1}, 0.5, 10);
        solve_scenes::add_block(room, {1.2, 0.8, 0}, {1.8, 1.3, 0.5}, 0.5);
        return room;
    }
    RowField filled(const auto& value) const {
        RowField out(links.rows().size(), 1);
        for (std::size_t i = 0; i < out.rows(); ++i) out[RowId(i)][0] = value(i);
        return out;
    }
    // Σ A x F y.
    double exchanged(Transport& transport, const RowField& x, const RowField& y) const {
        RowField H(y.rows(), 1);
        transport.gather(y, H);
        double sum = 0;
        for (std::size_t i = 0; i < y.rows(); ++i)
            sum += double(links.rows().area[i]) * double(x[RowId(i)][0] * H[RowId(i)][0]);
        return sum;
    }
};

LinkOptions options_for(double error) {
    LinkOptions options;
    options.error = error;
    options.tolerance = 0.1f;
    options.min_area = 1e-3f;
    return options;
}

TEST(Links, AddUpToOneInAClosedRoom) {
    Room room(0.25, options_for(0.05));
    ASSERT_TRUE(room.links.refine({}));
    const auto transport = room.links.transport();
    const RowField ones = room.filled([](std::size_t) { return 1.0f; });
    double area = 0;
    for (const float a : room.links.rows().area) area += double(a);
    // By kernels between places and the exact double integral of near pairs, nothing enforced.
    EXPECT_NEAR(room.exchanged(*transport, ones, ones) / area, 1, 0.01);
    // Rows are made to add up to what is asked for; each step halves what is missing.
    transport->scale_to(std::vector<float>(ones.rows(), 1.0f));
    RowField H(ones.rows(), 1);
    transport->gather(ones, H);
    for (std::size_t i = 0; i < ones.rows(); ++i)
        if (room.links.rows().area[i] > 0) {
            EXPECT_NEAR(H[RowId(i)][0], 1, 5e-3) << i;
        }
}

// What one node sends another it would get back: x · S y = y · S x, whatever x and y; and all that
// rows receive from one is what it sends.
TEST(Links, PullAndPushConserveLight) {
    Room room(0.5, options_for(0.1));
    ASSERT_TRUE(room.links.refine({}));
    const auto transport = room.links.transport();
    const RowField x = room.filled([](std::size_t i) { return float(uniform(1, i)); });
    const RowField y = room.filled([](std::size_t i) { return float(uniform(2, i)); });
    const double there = room.exchanged(*transport, x, y);
    EXPECT_GT(there, 0);
    EXPECT_NEAR(there, room.exchanged(*transport, y, x), 1e-5 * there);
    const RowField ones = room.filled([](std::size_t) { return 1.0f; });
    RowField sum(ones.rows(), 1), shot(ones.rows(), 1), gathered(ones.rows(), 1);
    transport->gather(y, gathered);
    for (std::size_t i = 0; i < ones.rows(); ++i) transport->shoot(RowId(i), y[RowId(i)], shot);
    for (std::size_t i = 0; i < ones.rows(); ++i)  // sums of some hundred floats
        EXPECT_NEAR(shot[RowId(i)][0], gathered[RowId(i)][0], 1e-4);
}

// Sixteen times the elements: 256 times the pairs, but about as many links for each element.
TEST(Links, GrowAsElementsDo) {
    LinkOptions options = options_for(0.1);
    options.divide = false;
    Room coarse(0.5, options), fine(0.125, options);
    ASSERT_TRUE(coarse.links.refine({}));
    ASSERT_TRUE(fine.links.refine({}));
    const auto per_row = [](const Room& room) {
        return double(room.links.links()) / double(room.links.rows().size());
    };
    EXPECT_GT(fine.links.rows().size(), 12 * coarse.links.rows().size());
    EXPECT_LT(per_row(fine), 3 * per_row(coarse));
    EXPECT_LT(per_row(fine), 0.05 * double(fine.links.rows().size()));
}

TEST(Links, StayWholeWhereTheyAreInterrupted) {
    for (const int rounds : {0, 1, 5, 20}) {
        LinkOptions options = options_for(0.01);
        int left = rounds;
        options.go_on = [&left](std::uint64_t) { return left-- > 0; };
        Room room(0.25, options);
        room.links.refine({});
        const auto transport = room.links.transport();
        const RowField ones = room.filled([](std::size_t) { return 1.0f; });
        double area = 0;
        for (const float a : room.links.rows().area) area += double(a);
        const double sum = room.exchanged(*transport, ones, ones) / area;
        EXPECT_TRUE(std::isfinite(sum));
        if (rounds == 0) {
            EXPECT_EQ(room.links.links(), 0u);
        } else if (rounds == 20) {
            EXPECT_NEAR(sum, 1, 0.3);  // still rough, but nothing is left out
        }
    }
}

SolveOptions cornell_options(std::string_view transport) {
    SolveOptions options;
    options.error = 0.05;
    options.solver = "jacobi";
    options.transport = transport;
    options.vertices = "average";
    options.adaptive = false;  // the same elements for both
    return options;
}

// The mean of elements, nothing gathered. What is left unshot, or the noise of samples, may take 15
// % of the error asked for, 5 %; links share the elements of the matrix, whose size is what that
// error is for.
TEST(Links, AgreeWithTheMatrixOnTheCornellBox) {
    const Scene scene = truth::cornell_box();
    const Solution dense = light(scene, cornell_options("dense"));
    for (const std::string_view transport : {"links", "stochastic"}) {
        const Solution other = light(scene, cornell_options(transport));
        ASSERT_EQ(dense.positions.size(), other.positions.size());
        for (std::size_t band = 0; band < 3; ++band) {
            const auto difference = solve_scenes::compare(dense, other, band, band);
            EXPECT_LT(difference.rms, 0.02) << transport << ", band " << band;
            EXPECT_LT(std::abs(difference.bias), 0.01) << transport << ", band " << band;
        }
    }
}

TEST(Links, KeepWhatThereIsWhenTimeIsOver) {
    const Scene scene = truth::cornell_box();
    SolveOptions options;
    options.error = 0.001;  // hours
    options.solver = "jacobi";
    options.transport = "links";
    options.time = 0.3;
    const Stopwatch clock;
    const Solution solution = light(scene, options);
    EXPECT_TRUE(solve_scenes::all_finite(solution));
    EXPECT_GT(solution.energy.emitted, 0);
    EXPECT_LT(std::abs(solution.energy.imbalance()), 0.05) << "what is not solved yet is unshot";
    EXPECT_LT(clock.seconds(), 20) << "a slow machine, and the lamps' light on all vertices";
}

}  // namespace
}  // namespace exitance
