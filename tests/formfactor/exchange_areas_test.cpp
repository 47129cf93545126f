// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/exchange_areas.h"

#include <gtest/gtest.h>

#include <array>

namespace exitance {
namespace {

TEST(ExchangeAreas, AreSymmetricHoweverARowIsKept) {
    ExchangeAreas areas(4);
    areas.set_row(0, std::array{1.0F});
    areas.set_row(1, std::array{2.0F, 3.0F});
    areas.set_row(2, std::array{0.0F, 0.0F, 5.0F});  // kept as one entry
    areas.set_row(3, {1, 3}, {6.0F, 7.0F});
    EXPECT_EQ(areas.at(1, 0), 2);
    EXPECT_EQ(areas.at(0, 1), 2);
    EXPECT_EQ(areas.at(2, 1), 0);
    EXPECT_EQ(areas.at(2, 2), 5);
    EXPECT_EQ(areas.at(1, 3), 6);
    EXPECT_EQ(areas.at(3, 2), 0);
    double sum = 0;
    for (std::size_t i = 0; i < areas.rows(); ++i)
        areas.visit_row(i, [&](std::size_t j, float area) { sum += area * (j == i ? 1 : 2); });
    EXPECT_EQ(sum, 1 + 2 * 2 + 3 + 5 + 2 * 6 + 7);
}

TEST(ExchangeAreas, SparseRowsTakeTheMemoryOfTheirEntries) {
    const std::size_t rows = 1000;
    ExchangeAreas areas(rows);
    std::vector<float> row;
    for (std::size_t i = 0; i < rows; ++i) {
        row.assign(i + 1, 0.0F);
        row[i / 2] = 1;
        areas.set_row(i, row);
    }
    EXPECT_LT(areas.bytes(), rows * 100);  // dense: 2 000 bytes a row
}

}  // namespace
}  // namespace exitance
