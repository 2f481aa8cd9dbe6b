// What this process holds of the kernel and of the heap: a test of leaks counts before and after.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include <gtest/gtest.h>
#include <malloc.h>

namespace octascope::tests {

// How often a test of leaks does what must leave nothing: as OCTASCOPE_LEAK_CYCLES says, or 200 times.
inline int leak_cycles() {
  const char* const given = std::getenv("OCTASCOPE_LEAK_CYCLES");
  return given != nullptr ? std::max(1, std::atoi(given)) : 200;
}

struct ResourceCount {
  std::size_t descriptors = 0;
  std::size_t mappings = 0;
  std::size_t threads = 0;
  std::size_t heap_bytes = 0;
};

inline ResourceCount resources_in_use() {
  ResourceCount count;
  count.heap_bytes = mallinfo2().uordblks; // before this function takes some itself
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator{"/proc/self/fd"})
    ++count.descriptors;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator{"/proc/self/task"})
    ++count.threads;
  std::ifstream maps{"/proc/self/maps"};
  for (std::string line; std::getline(maps, line);)
    ++count.mappings;
  return count;
}

inline std::ostream& operator<<(std::ostream& out, const ResourceCount& count) {
  return out << count.descriptors << " descriptors, " << count.mappings << " mappings, "
             << count.threads << " threads, " << count.heap_bytes << " bytes of heap";
}

// The heap itself may be split, and libraries keep something once.
struct Slack {
  std::size_t mappings = 1;
  std::size_t heap_bytes = 4096;
};

// Fails the test where more is in use than before; returns what is.
inline ResourceCount expect_no_leak(const ResourceCount& before, const Slack& slack = {}) {
  const ResourceCount after = resources_in_use();
  std::cout << "  before: " << before << "\n  after:  " << after << '\n';
  EXPECT_EQ(after.descriptors, before.descriptors);
  EXPECT_LE(after.mappings, before.mappings + slack.mappings);
  EXPECT_LE(after.heap_bytes, before.heap_bytes + slack.heap_bytes);
  return after;
}

} // namespace octascope::tests
