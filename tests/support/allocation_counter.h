// How often this thread has allocated: link allocation_counter.cpp, which replaces operator new.
#pragma once

#include <cstdint>

namespace octascope::tests {

// Since the calling thread began.
std::uint64_t allocations_of_this_thread();

} // namespace octascope::tests
