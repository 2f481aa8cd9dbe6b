// Random input that is new in every run, and can be had again.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>

#include <fmt/format.h>

namespace octascope::tests {

// Printed by the test that asks; OCTASCOPE_TEST_SEED sets it, to repeat what failed.
inline std::uint64_t fresh_seed() {
  const char* given = std::getenv("OCTASCOPE_TEST_SEED");
  const std::uint64_t seed = given != nullptr ? std::stoull(given) : std::random_device{}();
  fmt::print("  OCTASCOPE_TEST_SEED={}\n", seed);
  return seed;
}

} // namespace octascope::tests
