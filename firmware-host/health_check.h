// What a machine lacks to run the appliance well, and how to mend it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/clock.h"

namespace octascope::firmware_host {

enum class Verdict : std::uint8_t {
  good,
  limited, // it runs, with less
  fails,   // it does not run
};

struct HealthCheck {
  std::string subject; // "real-time priority"
  Verdict verdict = Verdict::good;
  std::string found;
  std::string mend; // empty when good
};

// Tries everything for real, on threads and contexts of its own; takes under two seconds.
std::vector<HealthCheck> check_health(hal::Clock& clock);

} // namespace octascope::firmware_host
