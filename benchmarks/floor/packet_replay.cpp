// SPDX-License-Identifier: Apache-2.0
#include "floor/packet_replay.h"

#include <embree3/rtcore.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

// The names are the linker's (ld --wrap).
extern "C" {
void __real_rtcOccluded16(const int*, RTCScene, RTCIntersectContext*, RTCRay16*);
void __wrap_rtcOccluded16(const int*, RTCScene, RTCIntersectContext*, RTCRay16*);
void __real_rtcIntersect16(const int*, RTCScene, RTCIntersectContext*, RTCRayHit16*);
void __wrap_rtcIntersect16(const int*, RTCScene, RTCIntersectContext*, RTCRayHit16*);
}

namespace exitance::benchmarks {

namespace {

// Short enough for the second-level cache, long enough to be timed.
constexpr std::size_t run_length = 512;

double thread_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Packets of one kind of query on their way.
template <class Rays, auto ask>
class Run {
  public:
    void add(const int* valid, RTCScene scene, const RTCIntersectContext& context,
             const Rays& rays) {
        ++passed_;
        for (std::size_t i = 0; i < 16; ++i) rays_ += valid[i] != 0;
        if (scene != scene_) {  // the other one may be gone: what is left of it is not replayed
            scene_ = scene;
            packets_.clear();
        }
        packets_.reserve(run_length);
        Packet& packet = packets_.emplace_back();
        std::copy_n(valid, 16, packet.valid.begin());
        packet.flags = context.flags;
        packet.rays = rays;
        if (packets_.size() == run_length) replay();
    }

    Replayed total() const {
        const double share =
            passed_ ? static_cast<double>(replayed_) / static_cast<double>(passed_) : 0.0;
        return {share > 0 ? seconds_ / share : 0.0, passed_, rays_, share};
    }

  private:
    struct alignas(64) Packet {
        std::array<int, 16> valid;
        RTCIntersectContextFlags flags;
        Rays rays;
    };

    void replay() {
        const double begin = thread_seconds();
        for (Packet& packet : packets_) {
            RTCIntersectContext context;
            rtcInitIntersectContext(&context);
            context.flags = packet.flags;
            ask(packet.valid.data(), scene_, &context, &packet.rays);
        }
        seconds_ += thread_seconds() - begin;
        replayed_ += packets_.size();
        packets_.clear();
    }

    RTCScene scene_ = nullptr;
    std::vector<Packet> packets_;
    double seconds_ = 0;
    std::uint64_t passed_ = 0, replayed_ = 0, rays_ = 0;
};

struct Runs {
    Run<RTCRay16, __real_rtcOccluded16> occluded;
    Run<RTCRayHit16, __real_rtcIntersect16> closest;
};

// Embree's functions know of no object that could hold it.
thread_local std::unique_ptr<Runs> runs;

}  // namespace

PacketReplay::PacketReplay() {
    runs = std::make_unique<Runs>();
}
PacketReplay::~PacketReplay() {
    runs.reset();
}
Replay PacketReplay::finish() {
    const Replay out{runs->occluded.total(), runs->closest.total()};
    runs.reset();
    return out;
}

}  // namespace exitance::benchmarks

void __wrap_rtcOccluded16(const int* valid, RTCScene scene, RTCIntersectContext* context,
                          RTCRay16* rays) {
    if (exitance::benchmarks::runs)
        exitance::benchmarks::runs->occluded.add(valid, scene, *context, *rays);
    __real_rtcOccluded16(valid, scene, context, rays);
}

void __wrap_rtcIntersect16(const int* valid, RTCScene scene, RTCIntersectContext* context,
                           RTCRayHit16* rays) {
    if (exitance::benchmarks::runs)
        exitance::benchmarks::runs->closest.add(valid, scene, *context, *rays);
    __real_rtcIntersect16(valid, scene, context, rays);
}
