#include "tests/soak/process_sample.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

namespace octascope::tests {

namespace {

std::size_t entries_of(const std::filesystem::path& folder) {
  std::error_code gone;
  std::size_t count = 0;
  for (std::filesystem::directory_iterator it{folder, gone}, last; !gone && it != last;
       it.increment(gone))
    ++count;
  return count;
}

} // namespace

std::optional<ProcessSample> sample_process(pid_t process) {
  const std::filesystem::path folder = "/proc/" + std::to_string(process);
  ProcessSample sample;
  std::ifstream status{folder / "status"};
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmRSS:"))
      sample.resident_kib = std::stod(line.substr(6));
  }
  if (sample.resident_kib == 0) // gone, or a zombie
    return std::nullopt;
  sample.descriptors = entries_of(folder / "fd");
  sample.threads = entries_of(folder / "task");
  return sample;
}

} // namespace octascope::tests
