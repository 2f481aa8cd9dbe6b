// Random input that is new in each run, and can be had again.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace octascope::tests {

// From OCTASCOPE_TEST_SEED where it is set, else drawn; printed and recorded with the test, so that
// a failure can be repeated.
inline unsigned fresh_seed() {
  const char* given = std::getenv("OCTASCOPE_TEST_SEED");
  const unsigned seed = given != nullptr ? static_cast<unsigned>(std::strtoul(given, nullptr, 10))
                                         : std::random_device{}();
  std::printf("  OCTASCOPE_TEST_SEED=%u\n", seed);
  testing::Test::RecordProperty("seed", std::to_string(seed));
  return seed;
}

} // namespace octascope::tests
