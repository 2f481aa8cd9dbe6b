#include "firmware-host/crash/run_marker.h"

#include <fstream>
#include <optional>
#include <string>
#include <system_error>

namespace octascope::firmware_host {

namespace {

std::optional<std::string> first_line(const std::filesystem::path& file) {
  std::ifstream in{file};
  if (!in)
    return std::nullopt;
  std::string line;
  std::getline(in, line);
  return line;
}

} // namespace

RunMarker::RunMarker(const std::filesystem::path& folder, const std::filesystem::path& boot_id)
    : file_{folder / "running"} {
  const std::string boot = first_line(boot_id).value_or("");
  if (const auto left = first_line(file_)) // empty: the power went while it was written
    last_run_ = *left == boot ? LastRun::crashed : LastRun::power_lost;
  std::ofstream{file_} << boot << '\n';
}

RunMarker::~RunMarker() {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

} // namespace octascope::firmware_host
