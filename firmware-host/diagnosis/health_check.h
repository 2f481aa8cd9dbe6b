// What keeps this machine from running the appliance well, and how to fix it.
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
  limited, // runs, with restrictions
  fails,   // does not run
};

struct HealthCheck {
  std::string subject; // "real-time priority"
  Verdict verdict = Verdict::good;
  std::string found;
  std::string remedy; // empty when good
};

// Tries everything for real, on its own threads and contexts; takes under two seconds.
std::vector<HealthCheck> check_health(hal::Clock& clock);

// One entry per error in the configuration file, or one that says which file is used. Without
// `file`: the machine's, if present.
std::vector<HealthCheck>
check_configuration(const std::optional<std::filesystem::path>& file = std::nullopt);

} // namespace octascope::firmware_host
