// For loops that the compiler vectorises: compiles one clone per processor generation; the loader
// chooses one at program start.
#pragma once

// Not with sanitizers, whose run-time is not ready when the choice is made, nor on other
// architectures, which do not need it.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(OCTASCOPE_SANITIZED)
#define OCTASCOPE_VECTOR_LOOP __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define OCTASCOPE_VECTOR_LOOP
#endif
