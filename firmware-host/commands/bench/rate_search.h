// Finds the highest line rate that holds. Pure.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "hal/result.h"

namespace octascope::firmware_host {

// Rates to choose from: 100 kHz to 6.4 MHz, each a quarter of an octave above the one before.
inline constexpr int rate_rungs = 25;
inline double rate_hz(int rung) {
  return std::round(100e3 * std::exp2(rung / 4.0));
}

struct FoundRate {
  int rung = -1;        // the highest that held; -1: none did
  bool complete = true; // else the time was over: a higher one may hold
};

struct SearchRange {
  int start = 0;          // the first that is tried
  int rungs = rate_rungs; // those from here on are known not to hold
};

// The highest rung that holds, if those below all do. Begins at the start and doubles its steps until
// one holds and one does not, then halves what is between, as long as there is time.
inline hal::Result<FoundRate> highest_rung(const SearchRange& range,
                                           const std::function<hal::Result<bool>(int rung)>& holds,
                                           const std::function<bool()>& time_is_left) {
  int held = -1;
  int failed = range.rungs;
  for (int rung = std::clamp(range.start, 0, failed - 1), step = 1; failed - held > 1; step *= 2) {
    if (!time_is_left())
      return FoundRate{held, false};
    HAL_TRY(const bool held_here, holds(rung));
    (held_here ? held : failed) = rung;
    const bool both = held >= 0 && failed < range.rungs;
    rung = both ? (held + failed) / 2 : held_here ? rung + step : rung - step;
    rung = std::clamp(rung, held + 1, std::max(failed - 1, held + 1));
  }
  return FoundRate{held, true};
}

} // namespace octascope::firmware_host
