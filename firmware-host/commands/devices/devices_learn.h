// octascope devices --learn: shows live what a control sends that octascope does not know, and
// writes what was learned.
#pragma once

#include <filesystem>
#include <string>

namespace octascope::firmware_host {

struct LearnOptions {
  std::string usb;                               // "1234:5678"; empty: the next to be plugged in
  std::filesystem::path out = "learned-control"; // .device.toml and .profile.toml are added
  double quiet_s = 15; // so long without a report, with a switch learned, ends it
};

// The exit status. Ends with SIGINT or SIGTERM, too, and writes what was learned until then.
int learn_control(const LearnOptions& options);

} // namespace octascope::firmware_host
