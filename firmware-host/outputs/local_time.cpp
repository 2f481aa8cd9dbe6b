#include "firmware-host/outputs/local_time.h"

#include <ctime>

#include <fmt/chrono.h>

namespace octascope::firmware_host {

std::string local_date_and_time(std::int64_t wall_clock_ns) {
  constexpr std::int64_t ns_per_s = 1'000'000'000;
  const std::time_t seconds = wall_clock_ns / ns_per_s;
  std::tm local{};
  if (wall_clock_ns <= 0 || localtime_r(&seconds, &local) == nullptr || local.tm_year > 8099)
    return "time not said";
  return fmt::format("{:04}-{:02}-{:02} {:02}:{:02}:{:02}", local.tm_year + 1900, local.tm_mon + 1,
                     local.tm_mday, local.tm_hour, local.tm_min, local.tm_sec);
}

std::string now_in_iso_8601() {
  const std::tm local = fmt::localtime(std::time(nullptr));
  const std::string offset = fmt::format("{:%z}", local); // +0100
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}{}:{}", local, offset.substr(0, 3), offset.substr(3));
}

std::string local_time_of_day() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  return fmt::format("{:02}:{:02}", local.tm_hour, local.tm_min);
}

} // namespace octascope::firmware_host
