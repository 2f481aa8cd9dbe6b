// octascope info of a recording of raw spectra.
#pragma once

#include <string>

namespace octascope::firmware_host {

struct InfoCommandLine {
  std::string file;
  bool json = false;
  bool configuration = false;
};

// Returns the exit status.
int print_raw_info(const InfoCommandLine& line);

} // namespace octascope::firmware_host
