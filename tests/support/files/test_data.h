// Where the real measurements are, for tests that want them.
#pragma once

#include <cstdlib>
#include <filesystem>

#include "tests/support/program/built_places.h"

namespace octascope::tests {

inline std::filesystem::path test_data_folder() {
  if (const char* folder = std::getenv("OCTASCOPE_TEST_DATA"))
    return folder;
  return source_folder() / "../shared/data";
}

} // namespace octascope::tests

// Skips the current test, saying why, where `file` (relative to the data folder) is missing.
#define OCTASCOPE_REQUIRE_TEST_DATA(file)                                                          \
  if (!std::filesystem::exists(octascope::tests::test_data_folder() / (file)))                     \
  GTEST_SKIP() << "no " << (octascope::tests::test_data_folder() / (file))                         \
               << "; set OCTASCOPE_TEST_DATA to the folder with the measurements"
