// For loops that the compiler vectorises: compiles one clone per processor generation; the loader
// chooses one at program start.
#pragma once

// Not with sanitizers: their run-time is not ready at that time. Other architectures need none.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(OCTASCOPE_SANITIZED)
#define OCTASCOPE_VECTOR_LOOP __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define OCTASCOPE_VECTOR_LOOP
#endif
