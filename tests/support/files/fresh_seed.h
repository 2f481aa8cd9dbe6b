// Seeds of random input: the same in each run, or drawn anew, and in either case printed.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace octascope::tests {

// A number made from the test's name and from how many seeds it has had before (32-bit FNV-1a).
inline unsigned seed_by_name(const testing::TestInfo& test) {
  const std::string name = std::string{test.test_suite_name()} + "." + test.name() + "#" +
                           std::to_string(test.result()->test_property_count());
  unsigned hash = 2166136261U;
  for (const char character : name)
    hash = (hash ^ static_cast<unsigned char>(character)) * 16777619U;
  return hash;
}

// Within a test. By the test's name, so that a run can be compared with any other one; drawn where
// OCTASCOPE_TEST_SEED is "random", as a stage of deploy/test --all has it; else what that says, so
// that a failure can be repeated. Printed and recorded with the test.
inline unsigned fresh_seed() {
  const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
  const char* const wanted = std::getenv("OCTASCOPE_TEST_SEED");
  unsigned seed = 0;
  if (wanted == nullptr)
    seed = seed_by_name(test);
  else if (std::string_view{wanted} == "random")
    seed = std::random_device{}();
  else
    seed = static_cast<unsigned>(std::strtoul(wanted, nullptr, 10));
  std::printf("  OCTASCOPE_TEST_SEED=%u\n", seed);
  testing::Test::RecordProperty("seed_" + std::to_string(test.result()->test_property_count()),
                                std::to_string(seed));
  return seed;
}

} // namespace octascope::tests
