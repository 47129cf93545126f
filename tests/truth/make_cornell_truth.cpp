// SPDX-License-Identifier: Apache-2.0
// Path traces tests/truth/cornell_irradiance.csv anew: some three minutes of one core.
#include <cstdio>
#include <exception>

#include "truth/cornell_box.h"
#include "truth/cornell_truth.h"

int main(int argc, char** argv) {
    using namespace exitance::truth;
    if (argc != 2) {
        std::fprintf(stderr, "usage: make_cornell_truth OUT.csv\n");
        return 2;
    }
    try {
        const auto receivers = cornell_receivers();
        const Estimate e = PathTracer(cornell_box()).irradiance(receivers, cornell_effort);
        CornellTruth truth;
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            truth.mean.push_back(e.at(i, green));
            truth.standard_error.push_back(e.error_at(i, green));
        }
        write_cornell_truth(truth, argv[1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "make_cornell_truth: %s\n", error.what());
        return 4;
    }
    return 0;
}
