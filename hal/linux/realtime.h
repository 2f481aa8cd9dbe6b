// Real-time scheduling and locked memory, where the system allows them.
#pragma once

#include <string_view>
#include <vector>

#include "hal/result.h"

namespace octascope::hal::linux_backend {

// Names the calling thread, as ps and gdb show it; longer names are cut to 15 characters.
void name_this_thread(std::string_view name);

// SCHED_FIFO for the calling thread. `priority` 1…49: below the kernel's threaded interrupts (50),
// which feed us. ErrorCode::denied with the remedy in the message where the privilege is missing.
Result<> make_this_thread_realtime(int priority);

// The cores that the process may use, in order: what taskset, cgroups and the service unit leave.
std::vector<int> allowed_cores();

// The calling thread runs on this core and no other. ErrorCode::invalid_argument: there is no such
// core, or it is not allowed.
Result<> pin_this_thread(int core);

// SCHED_IDLE-like: nice 19, for background work that may take as long as it likes.
void make_this_thread_background();

// Keeps all memory of the process, now and later, out of the swap.
Result<> lock_memory();

// Blocks of a MiB and more are mappings of their own from now on, and go back to the system when
// they are freed. Of itself the allocator puts them into its heap once one was freed, where each
// display that is opened again leaves gaps. At the start, before there are any.
void keep_large_blocks_apart();

} // namespace octascope::hal::linux_backend
