// What this process holds of the kernel and of the heap: a test of leaks counts before and after.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>

#include <malloc.h>

namespace octascope::tests {

struct ResourceCount {
  std::size_t descriptors = 0;
  std::size_t mappings = 0;
  std::size_t heap_bytes = 0;
};

inline ResourceCount resources_in_use() {
  ResourceCount count;
  count.heap_bytes = mallinfo2().uordblks; // before this function takes some itself
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator{"/proc/self/fd"})
    ++count.descriptors;
  std::ifstream maps{"/proc/self/maps"};
  for (std::string line; std::getline(maps, line);)
    ++count.mappings;
  return count;
}

inline std::ostream& operator<<(std::ostream& out, const ResourceCount& count) {
  return out << count.descriptors << " descriptors, " << count.mappings << " mappings, "
             << count.heap_bytes << " bytes of heap";
}

} // namespace octascope::tests
