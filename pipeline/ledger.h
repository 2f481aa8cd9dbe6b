// The history of one volume, from the trigger to the glass, and what was lost on the way.
#pragma once

#include <cstdint>

#include "hal/clock.h"

namespace octascope::pipeline {

struct VolumeLedger {
  std::uint64_t index = 0; // counts the volumes that were triggered, from 1; 0: no volume yet

  hal::TimePoint armed;      // rising edge of the trigger pulse
  hal::TimePoint first_line; // camera timestamps, of what came
  hal::TimePoint last_line;
  hal::TimePoint published; // when the renderer could take it

  hal::Duration reconstruct{}; // work of all workers, summed
  hal::Duration assemble{};    // neighbour averaging and bookkeeping

  std::int32_t lost_b_scans = 0; // never came, came too late, or came broken
  std::int32_t lost_lines = 0;   // kept lines of those B-scans
  std::int32_t saturated_lines = 0;
};

} // namespace octascope::pipeline
