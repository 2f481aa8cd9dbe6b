// Loops that the compiler vectorises, compiled once for each generation of the processor and
// chosen when the program is loaded.
#pragma once

// The choice is made before a sanitizer's run-time is ready, and other architectures have no need.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(OCTASCOPE_SANITIZED)
#define OCTASCOPE_VECTOR_LOOP __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define OCTASCOPE_VECTOR_LOOP
#endif
