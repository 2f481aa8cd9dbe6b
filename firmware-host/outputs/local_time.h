// Wall-clock times for people.
#pragma once

#include <cstdint>
#include <string>

namespace octascope::firmware_host {

// "2026-11-22 12:10:03", local time, from nanoseconds since 1970 (UTC). "time not said" for 0,
// negative times, and years of more than four digits.
std::string local_date_and_time(std::int64_t wall_clock_ns);

// "2026-11-22T12:10:03+01:00" of now.
std::string now_in_iso_8601();

// "14:05" of now, local time.
std::string local_time_of_day();

} // namespace octascope::firmware_host
