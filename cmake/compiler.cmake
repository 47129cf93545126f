# SPDX-License-Identifier: Apache-2.0
# Flags that every target of the project shares.
add_library(exitance_flags INTERFACE)
target_compile_features(exitance_flags INTERFACE cxx_std_20)
# No fused multiply-add contraction: the same bytes whichever instruction set a hot loop runs on.
target_compile_options(exitance_flags INTERFACE
  -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wcast-qual -Wpedantic
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # false positives on std::string + in GCC 12 (PR105329)
  -ffp-contract=off -fno-math-errno -fno-trapping-math)
if(EXITANCE_WERROR)
  target_compile_options(exitance_flags INTERFACE -Werror)
endif()
if(EXITANCE_NATIVE)
  target_compile_options(exitance_flags INTERFACE -march=native)
endif()
if(EXITANCE_SANITIZE)
  target_compile_options(exitance_flags INTERFACE -fsanitize=${EXITANCE_SANITIZE}
    -fno-omit-frame-pointer -fno-sanitize-recover=all
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)  # false positives in GCC's own headers when instrumented
  target_link_options(exitance_flags INTERFACE -fsanitize=${EXITANCE_SANITIZE})
endif()
if(EXITANCE_FUZZERS)  # lets libFuzzer see which branches an input takes
  target_compile_options(exitance_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()
