// Counts the heap allocations of the whole test executable that is linked with
// allocation_counter.cpp; for tests of hot paths.
#pragma once

#include <cstdint>

namespace octascope::tests {

// False under a sanitizer, which has the allocator to itself.
bool allocations_are_counted();

// Since the program started, by all threads: malloc, calloc, realloc, operator new, aligned ones.
std::uint64_t allocations();

} // namespace octascope::tests
