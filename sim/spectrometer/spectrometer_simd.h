// Loops that the compiler vectorises, compiled for each generation of the processor and chosen when
// the program is loaded.
#pragma once

// Not for sanitizers, whose run-time is not ready when the choice is made, nor for other
// architectures, which do not need it.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(OCTASCOPE_SANITIZED)
#define OCTASCOPE_VECTOR_LOOP __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define OCTASCOPE_VECTOR_LOOP
#endif
