// SPDX-License-Identifier: Apache-2.0
#include "exitance/transport/stochastic_rays.h"

#include <algorithm>
#include <cmath>

#include "exitance/math/warp.h"
#include "exitance/run/parallel.h"
#include "exitance/run/random.h"

namespace exitance {

namespace {

constexpr double width = RayPacket::width;
// However little is left to distribute.
constexpr double least_packets = 64;
// Shooters whose ends are kept before they are added up in order.
constexpr std::size_t at_once = 4096, block = 16;

struct End {
    std::uint32_t row, from;
    float share;  ///< of the exitance of `from`, as flux [m²]
};

}  // namespace

StochasticRays::StochasticRays(const ElementScene& scene, const ElementRows& rows,
                               const ElementCaster& caster, StochasticRaysOptions options)
    : scene_(scene),
      rows_(rows),
      caster_(caster),
      options_(std::move(options)),
      next_(rows.size(), 0) {}

double StochasticRays::accuracy() const {
    return 0.5 * std::pow(options_.rays_per_row, -0.5);
}

double StochasticRays::power(std::size_t row, std::span<const float> exitance) const {
    double magnitude = 0;
    for (std::size_t c = 0; c < exitance.size(); ++c)
        magnitude += double(options_.weight[c] * std::abs(exitance[c]));
    return double(rows_.area[row]) * magnitude;
}

bool StochasticRays::cast(std::size_t row, std::uint32_t packet, ElementCaster::Ends& ends) const {
    const std::uint64_t key = hash_bits(options_.seed, 0x57ull, rows_.elements[row].value);
    // Places and directions are two sequences that have nothing to do with each other (Burley
    // 2020).
    const std::uint32_t place = owen_scramble(packet, static_cast<std::uint32_t>(key >> 16));
    return caster_.cast_from(row, low_discrepancy(hash_bits(key), place), key, packet, ends);
}

void StochasticRays::send(std::span<const Shooter> shooters, const RowField& exitance,
                          RowField& irradiance) {
    const std::size_t stride = exitance.stride();
    for (std::size_t first = 0; first < shooters.size(); first += at_once) {
        const std::size_t count = std::min(at_once, shooters.size() - first);
        std::vector<std::vector<End>> ends((count + block - 1) / block);
        parallel_blocks(count, block, [&](std::size_t begin, std::size_t end) {
            ElementCaster::Ends met;
            for (std::size_t k = begin; k < end; ++k) {
                const auto [row, packets, stands_for] = shooters[first + k];
                // Places are spread over all of the element: those that are not open send nothing.
                const float area = scene_.mesh[rows_.elements[row]].area;
                const float share = area * stands_for / static_cast<float>(width);
                for (std::uint32_t p = 0; p < packets; ++p) {
                    if (!cast(row, next_[row] + p, met)) continue;
                    for (std::uint32_t e = 0; e < met.count; ++e)
                        if (rows_.area[met.row[e]] > 0)
                            ends[begin / block].push_back({met.row[e], row, share * met.rays[e]});
                }
                next_[row] += packets;
            }
        });
        for (const auto& list : ends)
            for (const End& end : list) {
                const auto H = irradiance[RowId(end.row)];
                const auto B = exitance[RowId(end.from)];
                const float factor = end.share / rows_.area[end.row];
                for (std::size_t c = 0; c < stride; ++c) H[c] += factor * B[c];
            }
    }
    for (const Shooter& s : shooters) counters_.rays += std::uint64_t{s.packets} * RayPacket::width;
}

void StochasticRays::gather(const RowField& exitance, RowField& irradiance) {
    for (std::size_t i = 0; i < rows(); ++i)
        std::fill(irradiance[RowId(i)].begin(), irradiance[RowId(i)].end(), 0.0f);
    double total = 0;
    for (std::size_t i = 0; i < rows(); ++i) total += power(i, exitance[RowId(i)]);
    most_power_ = std::max(most_power_, total);
    const std::uint64_t product = counters_.gathers++;
    if (!(total > 0)) return;
    const double packets = std::max(
        least_packets, options_.rays_per_row / width * double(rows()) * total / most_power_);
    // Systematic sampling: rows in their order, which lie side by side, are represented evenly.
    const double offset = uniform(hash_bits(options_.seed, 0x57ull), product);
    std::vector<Shooter> shooters;
    double passed = offset;
    for (std::size_t i = 0; i < rows(); ++i) {
        const double expected = packets * power(i, exitance[RowId(i)]) / total;
        const double before = std::floor(passed);
        passed += expected;
        const double sent = std::floor(passed) - before;
        if (sent >= 1)
            shooters.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(sent),
                                static_cast<float>(1 / expected)});
    }
    send(shooters, exitance, irradiance);
}

void StochasticRays::shoot(RowId from, std::span<const float> exitance, RowField& irradiance) {
    ++counters_.shots;
    if (!(power(from.index(), exitance) > 0)) return;
    const auto packets =
        static_cast<std::uint32_t>(std::ceil(std::max(options_.rays_per_row / width, 1.0)));
    RowField B(rows(), exitance.size());
    std::copy(exitance.begin(), exitance.end(), B[from].begin());
    const Shooter shooter{from.value, packets, 1.0f / static_cast<float>(packets)};
    send({&shooter, 1}, B, irradiance);
}

}  // namespace exitance
