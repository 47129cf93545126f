// SPDX-License-Identifier: Apache-2.0
// One binary, several instruction sets: a function marked EXITANCE_MULTIVERSION is compiled for
// AVX-512, AVX2 and the baseline, and the machine picks when the program starts. Contraction to
// fused multiply-add is off (cmake/compiler.cmake), so all versions give the same bits.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define EXITANCE_MULTIVERSION __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define EXITANCE_MULTIVERSION
#endif
