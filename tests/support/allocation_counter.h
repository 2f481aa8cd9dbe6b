<<<<<<< HEAD
// How often this thread has allocated: link allocation_counter.cpp, which replaces operator new.
=======
// Counts the heap allocations of the whole test executable that is linked with
// allocation_counter.cpp; for tests of hot paths.
>>>>>>> recon
#pragma once

#include <cstdint>

namespace octascope::tests {

<<<<<<< HEAD
// Since the calling thread began.
std::uint64_t allocations_of_this_thread();
=======
// False under a sanitizer, which has the allocator to itself.
bool allocations_are_counted();

// Since the program started, by all threads: malloc, calloc, realloc, operator new, aligned ones.
std::uint64_t allocations();
>>>>>>> recon

} // namespace octascope::tests
