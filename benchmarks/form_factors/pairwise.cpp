// SPDX-License-Identifier: Apache-2.0
// Form factors of a room: processor time, memory, and how far they are off: row sums (the room is
// closed), factors between whole faces, and the mean over rows of Σ_j |F_ij − finer F_ij|, the last
// two against a finer run.
#include <sys/resource.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include "exitance/formfactor/pairwise.h"
#include "form_factors/boxes.h"

namespace {

using namespace exitance;

double cpu_seconds() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    const auto seconds = [](const timeval& t) {
        return double(t.tv_sec) + 1e-6 * double(t.tv_usec);
    };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

long resident_peak_kib() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return used.ru_maxrss;
}

Enclosure scene(int argc, char** argv) {
    const auto number = [&](int k) { return static_cast<std::size_t>(std::stoul(argv[k])); };
    const std::string name = argc > 1 ? argv[1] : "";
    if (name == "empty" && argc > 2) return empty_room(number(2));
    if (name == "cube" && argc > 4) return room_with_cube(number(2), number(3), std::stod(argv[4]));
    if (name == "clutter" && argc > 4) return cluttered_room(number(2), number(3), number(4));
    if (name == "building" && argc > 5) return building(number(2), number(3), number(4), number(5));
    throw std::invalid_argument(
        "empty N | cube N M SIDE | clutter N K M | building ROOMS N K M, then --accuracy A --finer "
        "A --threads T");
}

double option(int argc, char** argv, const char* name, double otherwise) {
    for (int k = 1; k + 1 < argc; ++k)
        if (std::strcmp(argv[k], name) == 0) return std::stod(argv[k + 1]);
    return otherwise;
}

// Mean and greatest over rows of Σ_j |difference| / A_i.
struct RowErrors {
    double mean = 0, most = 0;
};
// Whole faces: facets of one plane, in the order in which they were made.
std::vector<std::size_t> faces(const Enclosure& room) {
    std::vector<std::size_t> of_row(room.surfaces.size());
    std::size_t face = 0;
    const Facet* before = nullptr;
    for (const Facet& facet : room.facets) {
        if (before && (dot(facet.normal, before->normal) < 1 - 1e-9 ||
                       std::abs(dot(facet.normal, facet.outline[0] - before->outline[0])) > 1e-9))
            ++face;
        of_row[facet.row] = face;
        before = &facet;
    }
    return of_row;
}

// Greatest |difference| of a factor from the smaller of two whole faces to the other.
double face_difference(const Enclosure& room, const ExchangeAreas& a, const ExchangeAreas& b) {
    const std::vector<std::size_t> face = faces(room);
    const std::size_t n = face.back() + 1;
    std::vector<double> area(n), off(n * n);
    for (std::size_t i = 0; i < face.size(); ++i) area[face[i]] += room.surfaces[i].area;
    for (std::size_t i = 0; i < a.rows(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const std::size_t f = std::max(face[i], face[j]), g = std::min(face[i], face[j]);
            off[f * n + g] += a.at(i, j) - b.at(i, j);
        }
    double most = 0;
    for (std::size_t f = 0; f < n; ++f)
        for (std::size_t g = 0; g < f; ++g)
            most = std::max(most, std::abs(off[f * n + g]) / std::min(area[f], area[g]));
    return most;
}

RowErrors difference(const Enclosure& room, const ExchangeAreas& a, const ExchangeAreas& b) {
    std::vector<double> sums(room.surfaces.size());
    for (std::size_t i = 0; i < a.rows(); ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            const double off = std::abs(a.at(i, j) - b.at(i, j));
            sums[i] += off;
            if (j != i) sums[j] += off;
        }
    RowErrors errors;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const double off = sums[i] / room.surfaces[i].area;
        errors.mean += off / double(sums.size());
        errors.most = std::max(errors.most, off);
    }
    return errors;
}

}  // namespace

int main(int argc, char** argv) try {
    const Enclosure room = scene(argc, argv);
    const auto threads = static_cast<std::size_t>(option(argc, argv, "--threads", 1));
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    PairwiseOptions options;
    options.accuracy = option(argc, argv, "--accuracy", options.accuracy);
    const double finer = option(argc, argv, "--finer", 0);

    const long before = resident_peak_kib();
    double cost = 1e30;
    PairwiseCounters counters;
    std::unique_ptr<ExchangeAreas> areas;
    for (int k = 0; k < int(option(argc, argv, "--repeat", 1)); ++k) {
        counters = {};
        const double start = cpu_seconds();
        areas = std::make_unique<ExchangeAreas>(
            pairwise_exchange_areas(room, options, {}, nullptr, &counters));
        cost = std::min(cost, cpu_seconds() - start);
    }
    const long after = resident_peak_kib();

    std::vector<double> sums(room.surfaces.size());
    for (std::size_t i = 0; i < areas->rows(); ++i)
        areas->visit_row(i, [&](std::size_t j, float area) {
            sums[i] += double(area);
            if (j != i) sums[j] += double(area);
        });
    double worst = 0, squares = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const double off = sums[i] / room.surfaces[i].area - 1;
        worst = std::max(worst, std::abs(off));
        squares += off * off;
    }
    std::printf(
        "{\"rows\": %zu, \"cpu_seconds\": %.4f, \"row_sum_error\": %.3e, "
        "\"row_sum_rms\": %.3e, \"bytes\": %zu, \"resident_kib\": %ld",
        sums.size(), cost, worst, std::sqrt(squares / double(sums.size())), areas->bytes(),
        after - before);
    const std::initializer_list<std::pair<const char*, std::uint64_t>> counted{
        {"pairs", counters.pairs},           {"separated", counters.separated},
        {"hidden", counters.hidden},         {"visible", counters.visible},
        {"partial", counters.partial},       {"sampled", counters.sampled},
        {"viewpoints", counters.viewpoints}, {"rays", counters.rays}};
    for (const auto& [name, count] : counted)
        std::printf(", \"%s\": %llu", name, static_cast<unsigned long long>(count));
    if (finer > 0) {
        options.accuracy = finer;
        const ExchangeAreas truth = pairwise_exchange_areas(room, options);
        const RowErrors errors = difference(room, *areas, truth);
        std::printf(", \"row_l1_mean\": %.3e, \"row_l1_most\": %.3e, \"face_error\": %.3e",
                    errors.mean, errors.most, face_difference(room, *areas, truth));
    }
    std::printf("}\n");
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
