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

// A real-time thread that never waits keeps a core from everything else, and so the program from
// being ended. demote_runaways() has the kernel notice (RLIMIT_RTTIME) when such a thread computed
// for longer than the limit without a wait. If it said with expect_waits() that each of its steps
// waits for something, it becomes an ordinary thread, and `demoted` is set, which must outlive it.
// Threads that did not say so, workers with much to do, are left alone; nothing is ended.
//
// The kernel raises the limit each time: call demote_runaways() once a second.
Result<> demote_runaways(Duration limit);
void expect_waits(std::atomic<bool>& demoted);

// The cores that taskset, cgroups and the service unit allow the process, in ascending order.
std::vector<int> allowed_cores();

// Pins the calling thread to one core. ErrorCode::invalid_argument: the core does not exist or is
// not allowed.
Result<> pin_this_thread(int core);

// Nice 19 for the calling thread: for background work without a deadline.
void make_this_thread_background();

// Locks all present and future memory of the process, so that none is swapped out.
Result<> lock_memory();

// Makes malloc map blocks of 1 MiB and more separately and return them to the system when they are
// freed. By default, glibc moves such blocks to its heap once one was freed, and reopening a
// display then fragments the heap. Call it at start-up, before the first such block.
void keep_large_blocks_apart();

} // namespace octascope::hal::linux_backend
