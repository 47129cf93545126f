// SPDX-License-Identifier: Apache-2.0
// EXITANCE_LANES floats that are computed with at once. A lane gives the same bits at every width:
// no operation here mixes lanes or is contracted. Included by instruction_sets.h, once for each
// instruction set, inside a namespace: hence no guard and no includes.

#define EXITANCE_WIDE_INLINE [[gnu::always_inline]] inline

typedef float Wide __attribute__((vector_size(4 * EXITANCE_LANES)));
typedef std::int32_t WideMask __attribute__((vector_size(4 * EXITANCE_LANES)));  // all bits or none

EXITANCE_WIDE_INLINE Wide wide(float value) {
    return value - Wide{};
}
EXITANCE_WIDE_INLINE Wide load(const float* from) {
    Wide v;
    std::memcpy(&v, from, sizeof v);
    return v;
}
EXITANCE_WIDE_INLINE void store(float* to, const Wide& v) {
    std::memcpy(to, &v, sizeof v);
}
EXITANCE_WIDE_INLINE Wide wide_min(const Wide& a, const Wide& b) {
    return a < b ? a : b;
}
EXITANCE_WIDE_INLINE Wide wide_max(const Wide& a, const Wide& b) {
    return a > b ? a : b;
}
EXITANCE_WIDE_INLINE Wide wide_abs(const Wide& a) {
    return a < 0.0f ? -a : a;
}
/// Bit k: lane k of the mask is set.
EXITANCE_WIDE_INLINE std::uint32_t lane_bits(const WideMask& mask) {
#if EXITANCE_LANES == 16
    return _mm512_movepi32_mask(reinterpret_cast<__m512i>(mask));
#elif EXITANCE_LANES == 8
    return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
#else
    std::uint32_t bits = 0;
    for (int k = 0; k < EXITANCE_LANES; ++k) bits |= (mask[k] & 1u) << k;
    return bits;
#endif
}
EXITANCE_WIDE_INLINE bool any(const WideMask& mask) {
    return lane_bits(mask) != 0;
}

/// 1/√x to 2e-7 of it, x > 0 normal: Newton's method from a guess by the exponent's bits (Lomont
/// 2003).
EXITANCE_WIDE_INLINE Wide reciprocal_root(const Wide& x) {
    WideMask bits;
    std::memcpy(&bits, &x, sizeof bits);
    bits = 0x5f375a86 - (bits >> 1);
    Wide y;
    std::memcpy(&y, &bits, sizeof y);
    const Wide half = x * 0.5f;
    y = y * (1.5f - half * y * y);
    y = y * (1.5f - half * y * y);
    return y * (1.5f - half * y * y);
}

/// Angle in [0, π] with the given sine ≥ 0 and cosine, both up to a common positive factor;
/// atan(q)/q as a polynomial in q² on [0, 1], error 1.4e-8.
EXITANCE_WIDE_INLINE Wide angle_of(const Wide& sine, const Wide& cosine) {
    const Wide c = wide_abs(cosine);
    const Wide small = wide_min(sine, c);
    const Wide large = wide_max(wide_max(sine, c), wide(1e-30f));
    const Wide q = small / large, z = q * q;
    Wide p = z * 0.0029035524814f - 0.0162830078008f;
    p = p * z + 0.0430393674540f;
    p = p * z - 0.0753367601448f;
    p = p * z + 0.1065467736397f;
    p = p * z - 0.1420713364428f;
    p = p * z + 0.1999305410479f;
    p = p * z - 0.3333309395707f;
    p = (p * z + 0.9999999863667f) * q;
    p = sine > c ? 1.57079632679f - p : p;
    return cosine < 0.0f ? 3.14159265359f - p : p;
}
