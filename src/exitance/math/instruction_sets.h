// SPDX-License-Identifier: Apache-2.0
// Compiles the header EXITANCE_LANES_SOURCE, which is written in terms of wide.h, for AVX-512, AVX2
// and the baseline, in namespaces exitance::lanes_16, lanes_8 and lanes_4; EXITANCE_LANES_CALL(f)
// then names the widest of them that this machine runs. To be included once, last, by a .cpp file.

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define EXITANCE_ALL_LANES 1
#include <immintrin.h>
#endif
#include <cstdint>
#include <cstring>

#ifdef EXITANCE_ALL_LANES
#pragma GCC diagnostic ignored "-Wpsabi"  // wide values only pass through inlined functions

#pragma GCC push_options
#pragma GCC target("arch=x86-64-v4")
#define EXITANCE_LANES 16
namespace exitance::lanes_16 {
#include "exitance/math/wide.h"
#include EXITANCE_LANES_SOURCE
}  // namespace exitance::lanes_16
#undef EXITANCE_LANES
#undef EXITANCE_WIDE_INLINE
#pragma GCC pop_options

#pragma GCC push_options
#pragma GCC target("avx2")
#define EXITANCE_LANES 8
namespace exitance::lanes_8 {
#include "exitance/math/wide.h"
#include EXITANCE_LANES_SOURCE
}  // namespace exitance::lanes_8
#undef EXITANCE_LANES
#undef EXITANCE_WIDE_INLINE
#pragma GCC pop_options
#endif

#define EXITANCE_LANES 4
namespace exitance::lanes_4 {
#include "exitance/math/wide.h"
#include EXITANCE_LANES_SOURCE
}  // namespace exitance::lanes_4
#undef EXITANCE_LANES
#undef EXITANCE_WIDE_INLINE

#ifdef EXITANCE_ALL_LANES
namespace exitance {
/// Floats that this machine computes with at once.
inline int machine_lanes() {
    static const int lanes =
        __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                __builtin_cpu_supports("avx512cd")
            ? 16
        : __builtin_cpu_supports("avx2") ? 8
                                         : 4;
    return lanes;
}
}  // namespace exitance
#define EXITANCE_LANES_CALL(function)                        \
    (::exitance::machine_lanes() == 16  ? lanes_16::function \
     : ::exitance::machine_lanes() == 8 ? lanes_8::function  \
                                        : lanes_4::function)
#else
#define EXITANCE_LANES_CALL(function) lanes_4::function
#endif
