#include "firmware-host/outputs/dated_file.h"

#include <ctime>
#include <system_error>

#include <fmt/chrono.h>

namespace octascope::firmware_host {

std::filesystem::path free_dated_name(const std::filesystem::path& folder, std::string_view prefix,
                                      std::string_view extension) {
  const std::string time = fmt::format("{:%Y%m%d-%H%M%S}", fmt::localtime(std::time(nullptr)));
  std::filesystem::path file = folder / fmt::format("{}-{}{}", prefix, time, extension);
  std::error_code ignored; // what cannot be looked at cannot be written, which is told then
  for (int i = 2; std::filesystem::exists(file, ignored); ++i)
    file = folder / fmt::format("{}-{}-{}{}", prefix, time, i, extension);
  return file;
}

} // namespace octascope::firmware_host
