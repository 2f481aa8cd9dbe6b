// What a machine lacks to run the appliance well, and how to fix it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
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
  std::string remedy; // empty when good
};

// Tries everything for real, on threads and contexts of its own; takes under two seconds.
std::vector<HealthCheck> check_health(hal::Clock& clock);

// One a complaint about the configuration file, or one that says which is used. Without `file` the
// machine's, where there is one.
std::vector<HealthCheck>
check_configuration(const std::optional<std::filesystem::path>& file = std::nullopt);

} // namespace octascope::firmware_host
