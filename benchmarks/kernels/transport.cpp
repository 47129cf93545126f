// SPDX-License-Identifier: Apache-2.0
// The inner loops of a shot on their own, one thread: rates per receiver or ray.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "exitance/formfactor/point_polygon_block.h"
#include "exitance/scene/read.h"
#include "exitance/solve/radiosity.h"
#include "exitance/transport/column.h"
#include "exitance/visibility/visible_fraction.h"

namespace {

using namespace exitance;

/// A scene, meshed evenly, with its lamps, and its vertices in blocks as a shot takes them.
struct Place {
    Scene scene;
    Radiosity radiosity;
    std::vector<Source> sources;
    std::vector<ReceiverBlock> blocks;

    Place(const std::string& file, double patch_size)
        : scene(read_scene(EXITANCE_SOURCE_DIR "/scenes/" + file)),
          radiosity(scene, make_groups(scene, Grouping::none), {patch_size, true}) {
        for (const Face& face : radiosity.mesh.faces())
            if (radiosity.emits(face))
                sources.push_back(radiosity.source(face, radiosity.mesh.corners(face)));
        std::vector<std::uint32_t> all(radiosity.receivers.size());
        std::iota(all.begin(), all.end(), 0u);
        for (std::size_t first = 0; first < all.size(); first += ReceiverBlock::capacity)
            blocks.emplace_back().load(radiosity.receivers, &all[first],
                                       std::min(ReceiverBlock::capacity, all.size() - first));
    }
};

const Place& cornell() {
    static const Place place("cornell.toml", 0.02);
    return place;
}
const Place& office() {
    static const Place place("office.toml", 0.5);
    return place;
}

void factors(benchmark::State& state, const Place& (*where)()) {
    const Place& place = where();
    const auto clearance = static_cast<float>(place.radiosity.caster.clearance());
    alignas(64) std::array<float, ReceiverBlock::capacity> out;
    std::int64_t receivers = 0;
    std::size_t source = 0;
    for (auto _ : state) {
        for (const ReceiverBlock& block : place.blocks) {
            point_polygon_factors(block, place.sources[source], clearance, out.data());
            benchmark::DoNotOptimize(out.data());
            benchmark::ClobberMemory();
            receivers += static_cast<std::int64_t>(block.size);
        }
        source = (source + 1) % place.sources.size();
    }
    state.SetItemsProcessed(receivers);
}

// Rays per receiver, all of them cast; receivers that cannot see the source are left out.
void fractions(benchmark::State& state, const Place& (*where)(), bool occlusion) {
    const Place& place = where();
    const auto clearance = static_cast<float>(place.radiosity.caster.clearance());
    const auto rays = static_cast<std::uint8_t>(state.range(0));
    alignas(64) std::array<float, ReceiverBlock::capacity> factor;
    RayBudget budget;
    VisibleFractions out;
    std::int64_t cast = 0;
    std::size_t source = 0;
    for (auto _ : state) {
        for (const ReceiverBlock& block : place.blocks) {
            state.PauseTiming();
            point_polygon_factors(block, place.sources[source], clearance, factor.data());
            for (std::size_t r = 0; r < block.size; ++r) {
                budget.probe[r] = factor[r] > 0 ? rays : std::uint8_t{0};
                budget.most[r] = rays;
                cast += budget.probe[r];
            }
            state.ResumeTiming();
            find_visible_fractions(place.radiosity.caster, place.sources[source], block, budget,
                                   occlusion, 1, out);
            benchmark::DoNotOptimize(out);
        }
        source = (source + 1) % place.sources.size();
    }
    state.SetItemsProcessed(cast);
}

// Sixteen neighbouring receivers to one point of the source: the most coherent packets there are.
void occluded(benchmark::State& state, const Place& (*where)()) {
    const Place& place = where();
    std::vector<RayPacket> packets;
    for (const ReceiverBlock& block : place.blocks)
        for (std::size_t first = 0; first + RayPacket::width <= block.size;
             first += RayPacket::width) {
            const Source& source = place.sources[packets.size() % place.sources.size()];
            const Vec3f to = 0.5f * (source.corners[0] + source.corners[2]);
            RayPacket& rays = packets.emplace_back();
            for (std::size_t i = 0; i < RayPacket::width; ++i) {
                const std::size_t r = first + i;
                rays.origin_x[i] = block.x[r] + 1e-4f * block.nx[r];
                rays.origin_y[i] = block.y[r] + 1e-4f * block.ny[r];
                rays.origin_z[i] = block.z[r] + 1e-4f * block.nz[r];
                rays.direction_x[i] = to.x - rays.origin_x[i];
                rays.direction_y[i] = to.y - rays.origin_y[i];
                rays.direction_z[i] = to.z - rays.origin_z[i];
                rays.near[i] = 0;
                rays.far[i] = 0.999f;
            }
            rays.active = 0xffffu;
        }
    for (auto _ : state)
        for (const RayPacket& rays : packets)
            benchmark::DoNotOptimize(place.radiosity.caster.occluded(rays));
    state.SetItemsProcessed(state.iterations() *
                            static_cast<std::int64_t>(packets.size() * RayPacket::width));
}

}  // namespace

BENCHMARK_CAPTURE(factors, cornell, cornell);
BENCHMARK_CAPTURE(factors, office, office);
BENCHMARK_CAPTURE(occluded, cornell, cornell);
BENCHMARK_CAPTURE(occluded, office, office);
BENCHMARK_CAPTURE(fractions, cornell, cornell, true)->Arg(1)->Arg(16);
BENCHMARK_CAPTURE(fractions, cornell_unblocked, cornell, false)->Arg(1)->Arg(16);
BENCHMARK_CAPTURE(fractions, office, office, true)->Arg(1)->Arg(16);

BENCHMARK_MAIN();
