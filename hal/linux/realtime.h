// Real-time scheduling and locked memory, if the system allows them.
#pragma once

#include <atomic>
#include <string_view>
#include <vector>

#include "hal/clock.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

// Names the calling thread, as ps and gdb show it; longer names are cut to 15 characters.
void name_this_thread(std::string_view name);

// SCHED_FIFO for the calling thread. `priority` 1…49: below the kernel's threaded interrupts (50),
// which deliver the data. ErrorCode::denied: the privilege is missing; the message has the remedy.
Result<> make_this_thread_realtime(int priority);

// A real-time thread that never waits keeps a core from everything else, so that the program cannot
// even be ended. demote_runaways() asks the kernel (RLIMIT_RTTIME) to signal a thread that computes
// for longer than the limit without waiting. A thread that has called expect_waits(), because each
// of its steps waits, then becomes an ordinary one and `demoted`, which must outlive it, is set.
// Other threads, such as busy workers, are left alone. Nothing is ended.
//
// The kernel raises the limit each time: call demote_runaways() once a second.
Result<> demote_runaways(Duration limit);
void expect_waits(std::atomic<bool>& demoted);

// The cores that taskset, cgroups and the service unit allow the process, in ascending order.
std::vector<int> allowed_cores();

// Pins the calling thread to one core. ErrorCode::invalid_argument: the core does not exist or is
// not allowed.
Result<> pin_this_thread(int core);

// SCHED_IDLE for the calling thread: for background work without a deadline. Unlike one of nice 19, which
// keeps its core to the end of its turn, some milliseconds, it goes as soon as another one wakes.
void make_this_thread_background();

// Locks all present and future memory of the process, so that none is swapped out.
Result<> lock_memory();

// Makes malloc map blocks of 1 MiB and more separately and return them to the system when they are
// freed. By default, glibc moves such blocks to its heap once one was freed, and reopening a
// display then fragments the heap. Call it at start-up, before the first such block.
void keep_large_blocks_apart();

} // namespace octascope::hal::linux_backend
