// SPDX-License-Identifier: Apache-2.0
#include "truth/cornell_truth.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "exitance/run/atomic_file.h"
#include "exitance/run/error.h"
#include "truth/cornell_box.h"

namespace exitance::truth {

namespace {

constexpr std::size_t rows = 2 * 64 * 64;

}  // namespace

std::vector<Receiver> cornell_receivers() {
    std::vector<Receiver> out;
    for (const SensorGrid& grid : cornell_box().grids)
        for (const Receiver& receiver : centres_of(grid)) out.push_back(receiver);
    return out;
}

std::filesystem::path cornell_truth_path() {
    return std::filesystem::path(EXITANCE_TRUTH_DIR) / "cornell_irradiance.csv";
}

CornellTruth read_cornell_truth() {
    const std::string path = cornell_truth_path().string();
    std::ifstream in(path);
    CornellTruth out;
    std::string line;
    std::size_t number = 0;
    while (std::getline(in, line)) {
        ++number;
        if (line.empty() || line[0] == '#') continue;
        std::istringstream fields(line);
        double mean = 0, error = 0;
        char comma = 0;
        if (!(fields >> mean >> comma >> error) || comma != ',')
            throw Error(Place{path, number, 0}, "found '" + line + "', expected 'mean,error'");
        out.mean.push_back(mean);
        out.standard_error.push_back(error);
    }
    if (out.mean.size() != rows)
        throw Error(Place{path, 0, 0},
                    fmt::format("found {} rows, expected {}", out.mean.size(), rows));
    return out;
}

void write_cornell_truth(const CornellTruth& truth, const std::filesystem::path& path) {
    write_atomically(path, [&](std::ostream& out) {
        out << fmt::format(
            "# SPDX-License-Identifier: Apache-2.0\n"
            "# Irradiance in the Cornell box of tests/truth/cornell_box.cpp [W/m²], green band:\n"
            "# mean, standard error; 64 x 64 points of the grid \"floor\", then of \"back\", row "
            "by "
            "row.\n"
            "# {} paths per point (samples {}, replicates {}), seed {}, by\n"
            "#     cmake --build build --target make_cornell_truth\n"
            "#     build/bin/make_cornell_truth tests/truth/cornell_irradiance.csv\n",
            cornell_effort.samples * cornell_effort.replicates, cornell_effort.samples,
            cornell_effort.replicates, cornell_effort.seed);
        for (std::size_t i = 0; i < truth.mean.size(); ++i)
            out << fmt::format("{:.6g},{:.3g}\n", truth.mean[i], truth.standard_error[i]);
    });
}

}  // namespace exitance::truth
