// SPDX-License-Identifier: Apache-2.0
// How fast Embree alone answers the very packets that the program asks. Programs that link this
// wrap rtcOccluded16 and rtcIntersect16; packets are copied on their way and, a run at a time,
// asked again with nothing else between the calls.
#pragma once

#include <cstdint>

namespace exitance::benchmarks {

struct Replayed {
    double seconds = 0;  ///< processor time for all packets, extrapolated from those replayed
    std::uint64_t packets = 0;  ///< all that passed
    std::uint64_t rays = 0;     ///< their active lanes
    double share = 0;           ///< of the packets, how many were replayed
};

struct Replay {
    Replayed occluded, closest;
};

/// From construction to finish(), packets of this thread are replayed; one at a time may live.
class PacketReplay {
  public:
    PacketReplay();
    ~PacketReplay();
    PacketReplay(const PacketReplay&) = delete;
    PacketReplay& operator=(const PacketReplay&) = delete;

    Replay finish();
};

}  // namespace exitance::benchmarks
