// octascope devices --learn: shows live what an unknown control sends, and writes what was learned.
#pragma once

#include <filesystem>
#include <string>

namespace octascope::firmware_host {

struct LearnOptions {
  std::string usb;                               // "1234:5678"; empty: the next to be plugged in
  std::filesystem::path out = "learned-control"; // .device.toml and .profile.toml are added
  double quiet_s = 15; // ends after this long without a report, once a switch is learned
};

// Returns the exit status. Also ends on SIGINT or SIGTERM, and then writes what was learned so far.
int learn_control(const LearnOptions& options);

} // namespace octascope::firmware_host
