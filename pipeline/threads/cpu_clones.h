// Hot loops, compiled once for every generation of x86-64 and chosen when the program starts.
#pragma once

// The program is built for the first x86-64, so that it runs anywhere. A function marked with this
// exists three times in it: baseline, AVX2 with FMA, AVX-512. The choice is made by resolvers that
// run before main(), which the sanitizers' run time does not survive: they test the baseline.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(OCTASCOPE_SANITIZED)
#define OCTASCOPE_CPU_CLONES                                                                       \
  __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define OCTASCOPE_CPU_CLONES
#endif
