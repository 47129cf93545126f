// SPDX-License-Identifier: Apache-2.0
// Every transport is H = F B: matrices against sums in double, rays against closed rooms.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <memory>
#include <vector>

#include "exitance/run/random.h"
#include "exitance/scene/groups.h"
#include "exitance/solve/radiosity.h"
#include "exitance/transport/dense.h"
#include "exitance/transport/exchange_by_casting.h"
#include "exitance/transport/on_the_fly.h"
#include "exitance/transport/sparse.h"
#include "exitance/transport/stochastic_rays.h"
#include "solve/solve_scenes.h"

namespace exitance {
namespace {

// Symmetric exchange areas with gaps; row 7 has no area. 150 rows are not whole tiles of 64.
struct Matrix {
    static constexpr std::size_t n = 150;
    std::vector<double> S = std::vector<double>(n * n);
    std::vector<float> area = std::vector<float>(n);

    Matrix() {
        for (std::uint32_t i = 0; i < n; ++i) {
            area[i] = i == 7 ? 0.0f : 0.5f + uniform(1, i);
            for (std::uint32_t j = 0; j <= i; ++j)
                if (i != 7 && j != 7 && uniform(2, i * 1000 + j) > 0.6f)
                    S[i * n + j] = S[j * n + i] = double(uniform(3, i * 1000 + j));
        }
    }
    ExchangeAreas areas() const {
        ExchangeAreas out(n);
        for (std::size_t i = 0; i < n; ++i) {
            std::vector<float> row(i + 1);
            for (std::size_t j = 0; j <= i; ++j) row[j] = static_cast<float>(S[i * n + j]);
            out.set_row(i, row);
        }
        return out;
    }
};

RowField some_exitance(std::size_t rows, std::size_t columns) {
    RowField B(rows, columns);
    for (std::uint32_t i = 0; i < rows; ++i)
        for (std::uint32_t c = 0; c < columns; ++c) B[RowId(i)][c] = uniform(4, i * 100 + c);
    return B;
}

// Float sums of 60 terms: 60 roundings of 6e-8 at most.
TEST(Transports, MatricesAreTheirSums) {
    const Matrix matrix;
    for (const std::size_t columns : {1ul, 3ul, 6ul, 21ul}) {
        const RowField B = some_exitance(Matrix::n, columns);
        std::vector<std::unique_ptr<Transport>> both;
        both.push_back(std::make_unique<DenseTransport>(matrix.areas(), matrix.area, 0.0));
        both.push_back(std::make_unique<SparseTransport>(matrix.areas(), matrix.area, 0.0));
        for (const auto& transport : both) {
            RowField H(Matrix::n, columns), shot(Matrix::n, columns);
            transport->gather(B, H);
            for (std::size_t j = 0; j < Matrix::n; ++j)
                transport->shoot(RowId(j), B[RowId(j)], shot);
            for (std::size_t i = 0; i < Matrix::n; ++i)
                for (std::size_t c = 0; c < columns; ++c) {
                    double sum = 0;
                    for (std::size_t j = 0; j < Matrix::n; ++j)
                        sum += matrix.S[i * Matrix::n + j] * double(B[RowId(j)][c]);
                    const double h = matrix.area[i] > 0 ? sum / double(matrix.area[i]) : 0;
                    EXPECT_NEAR(double(H[RowId(i)][c]), h, 4e-6 * h);
                    EXPECT_NEAR(double(shot[RowId(i)][c]), h, 4e-6 * h);
                }
            EXPECT_TRUE(transport->symmetric());
            EXPECT_EQ(transport->counters().gathers, 1u);
            EXPECT_EQ(transport->counters().shots, Matrix::n);
        }
        EXPECT_EQ(both[0]->bytes(), DenseTransport::bytes_for(Matrix::n));
        EXPECT_LT(both[1]->bytes(), 8 * 0.45 * Matrix::n * Matrix::n + 16 * Matrix::n);
    }
}

// The inside of a box is closed: with B = 1 everywhere each row gets H = 1, whether it gathers or
// all rows shoot.
struct ClosedBox {
    Scene scene = room();
    Radiosity radiosity{scene, make_groups(scene, Grouping::none), {0.5, false}};
    ElementScene elements{radiosity.mesh, radiosity.caster, radiosity.owners,
                          radiosity.two_sided()};
    ElementRows rows = make_element_rows(elements);
    RowPoints points = make_row_points(elements, rows);
    ElementCaster rays{elements, rows, 256, 0}, fine_rays{elements, rows, 4096, 1};

    static Scene room() {
        Scene made;
        solve_scenes::add_room(made, {}, {3, 2, 1}, 0.5);
        return made;
    }

    std::vector<std::unique_ptr<Transport>> transports() const {
        const auto cast = [&] {
            return cast_exchange_areas(rays, rows, [](std::uint64_t) { return true; });
        };
        std::vector<std::unique_ptr<Transport>> all;
        all.push_back(std::make_unique<DenseTransport>(cast(), rows.area, 0.0));
        all.push_back(std::make_unique<SparseTransport>(cast(), rows.area, 0.0));
        OnTheFlyOptions options;
        options.tolerance = 1e-3f;
        options.weight = {1, 0, 0, 0};
        all.push_back(
            std::make_unique<OnTheFlyTransport>(elements, rows, points, rays, options, 0));
        return all;
    }
};

TEST(Transports, ConserveLightInAClosedRoom) {
    const ClosedBox box;
    const std::size_t n = box.rows.size();
    RowField B(n, 1);
    for (std::size_t i = 0; i < n; ++i) B[RowId(i)][0] = 1;
    for (const auto& transport : box.transports()) {
        RowField gathered(n, 1), shot(n, 1);
        transport->gather(B, gathered);
        for (std::size_t j = 0; j < n; ++j) transport->shoot(RowId(j), B[RowId(j)], shot);
        for (std::size_t i = 0; i < n; ++i) {
            // Rays all end somewhere; matrices are scaled until that holds to 1e-3.
            EXPECT_NEAR(gathered[RowId(i)][0], 1, 2e-3);
            // Exact factors at four Gauss points of every element, whose mean is less exact where
            // elements meet in a corner.
            EXPECT_NEAR(shot[RowId(i)][0], 1, 0.05);
        }
        EXPECT_GT(transport->bytes(), 0u);
    }
}

// Products of fresh rays: each sends all the power that there is, and differs from the others; the
// mean of many is F.
TEST(Transports, StochasticRaysAreRightOnAverage) {
    const ClosedBox box;
    const std::size_t n = box.rows.size();
    StochasticRays rays(box.elements, box.rows, box.rays, {64, {1, 0, 0, 0}, 5});
    EXPECT_TRUE(rays.random());
    const RowField B = some_exitance(n, 1);
    RowField exact(n, 1), H(n, 1), mean(n, 1);
    SparseTransport matrix(
        cast_exchange_areas(box.fine_rays, box.rows, [](std::uint64_t) { return true; }),
        box.rows.area, 0.0);
    matrix.gather(B, exact);
    const auto distance = [&](const RowField& found) {
        double square = 0;
        for (std::size_t i = 0; i < n; ++i)
            square += std::pow(double(found[RowId(i)][0] / exact[RowId(i)][0]) - 1, 2);
        return std::sqrt(square / double(n));
    };
    constexpr int products = 256;
    for (int k = 0; k < products; ++k) {
        rays.gather(B, H);
        double sent = 0, arrived = 0;
        for (std::size_t i = 0; i < n; ++i) {
            sent += double(box.rows.area[i] * B[RowId(i)][0]);
            arrived += double(box.rows.area[i] * H[RowId(i)][0]);
            mean[RowId(i)][0] += H[RowId(i)][0] / products;
        }
        // The rounding of each row's packets, of which there are some hundreds.
        ASSERT_NEAR(arrived, sent, 0.03 * sent);
        if (k == 0) {
            EXPECT_GT(distance(H), 0.03);
        }
    }
    // Some hits a row and product, 256 of them; and the matrix's own noise of 4096 rays.
    EXPECT_LT(distance(mean), 0.015);
    EXPECT_EQ(rays.counters().gathers, std::uint64_t{products});

    // A shot is a column: a row's rays all arrive somewhere.
    RowField shot(n, 1);
    const std::vector<float> one{1, 0, 0, 0};
    rays.shoot(RowId(3), one, shot);
    double arrived = 0;
    for (std::size_t i = 0; i < n; ++i) arrived += double(box.rows.area[i] * shot[RowId(i)][0]);
    EXPECT_NEAR(arrived, double(box.rows.area[3]), 1e-4);
}

TEST(Transports, DoNotDependOnThreads) {
    const auto gathered = [](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const ClosedBox box;
        std::vector<std::vector<float>> out;
        const RowField B = some_exitance(box.rows.size(), 3);
        for (const auto& transport : box.transports()) {
            RowField H(box.rows.size(), 3);
            transport->gather(B, H);
            transport->shoot(RowId(5), B[RowId(5)], H);
            out.emplace_back(H.values().begin(), H.values().end());
        }
        return out;
    };
    EXPECT_EQ(gathered(1), gathered(3));
}

}  // namespace
}  // namespace exitance
