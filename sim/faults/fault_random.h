// Pseudo-random numbers that are functions of their input, so that faults repeat exactly.
#pragma once

#include <cstdint>

namespace octascope::sim {

// The finaliser of SplitMix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators,
// OOPSLA 2014).
constexpr std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

// Maps 64-bit numbers uniformly to [0, 1).
constexpr double even_number(std::uint64_t x) {
  return static_cast<double>(x >> 11) * 0x1.0p-53;
}

} // namespace octascope::sim
