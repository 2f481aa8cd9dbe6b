// octascope devices --learn: shows live what an unknown control sends, and writes what was learned.
#pragma once

#include <filesystem>
#include <string>

namespace octascope::firmware_host {

struct LearnOptions {
  std::string usb;                               // "1234:5678"; empty: the next to be plugged in
  std::filesystem::path out = "learned-control"; // .device.toml and .profile.toml are added
  double quiet_s = 15;     // ends after this long without a report, once a switch is learned; where
                           // standard input is no terminal, also before that
  bool reads_input = true; // else the answers of somebody else, who reads ahead, come there
};

// Returns the exit status. Also ends on SIGINT or SIGTERM, and then writes what was learned so far.
// Before a device was plugged in, a line on standard input or its end is the end, too, where it is read.
int learn_control(const LearnOptions& options);

} // namespace octascope::firmware_host
