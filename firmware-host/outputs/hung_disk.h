// The end of what writes to a disk, and of a program whose disk hangs: nobody can end a thread that
// waits in the kernel.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "hal/clock.h"
#include "hal/result.h"

namespace octascope::firmware_host {

// Without progress. A service is killed 3 s after it was told to end (TimeoutStopSec); a disk that
// writes what waits in the machine's memory may take longer.
inline constexpr std::chrono::seconds patience_of_service{2};
inline constexpr std::chrono::seconds patience_at_terminal{20};

// Runs `end` on a thread of its own until it returns, or until `progress` has stood still for
// `patience`. False: the thread goes on, with all that it uses: end the program by leave_at_once().
bool ends_in_time(std::function<void()> end, const std::function<std::uint64_t()>& progress,
                  hal::Duration patience, hal::Clock& clock);

// What is to be said of a file whose disk did not end in time. `kept`: of what, and how many.
hal::Error hung_disk(const std::string& file, const std::string& kept, hal::Duration patience);

// Writes out what was said, and ends the program without waiting for any thread. What other devices
// are to be released must be so by then.
[[noreturn]] void leave_at_once(int exit_status);

} // namespace octascope::firmware_host
