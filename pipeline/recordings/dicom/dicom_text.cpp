#include "pipeline/recordings/dicom/dicom_text.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "hal/plain_text.h"

namespace octascope::pipeline {

namespace {

constexpr std::size_t longest_long_string = 64;

} // namespace

bool is_long_string(std::string_view text) {
  std::size_t characters = 0;
  while (!text.empty()) {
    const std::size_t length = hal::utf8_character_length(text);
    if (length == 0 || text.front() == '\\' || hal::is_control_character(text.substr(0, length)))
      return false;
    text.remove_prefix(length);
    ++characters;
  }
  return characters <= longest_long_string;
}

std::string to_long_string(std::string_view text) {
  std::string fitting;
  for (std::size_t characters = 0; !text.empty() && characters < longest_long_string;
       ++characters) {
    const std::size_t length = hal::utf8_character_length(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
    if (length == 0)
      fitting += '?';
    else if (hal::is_control_character(character))
      fitting += ' ';
    else
      fitting += character == "\\" ? std::string_view{"/"} : character;
    text.remove_prefix(character.size());
  }
  return fitting;
}

std::string to_decimal_string(double value) {
  return fmt::format("{:.9g}", value);
}

std::optional<std::chrono::minutes> offset_from_utc(std::string_view time) {
  using std::chrono::minutes;
  if (time.ends_with('Z'))
    return minutes{0};
  if (time.size() < 6)
    return std::nullopt;
  const std::string_view offset = time.substr(time.size() - 6);
  const auto digit = [&](std::size_t i) { return offset[i] - '0'; };
  for (const std::size_t i : {1U, 2U, 4U, 5U}) {
    if (digit(i) < 0 || digit(i) > 9)
      return std::nullopt;
  }
  if ((offset[0] != '+' && offset[0] != '-') || offset[3] != ':')
    return std::nullopt;
  const minutes size{60 * (10 * digit(1) + digit(2)) + 10 * digit(4) + digit(5)};
  if (size > std::chrono::hours{14}) // the farthest on Earth
    return std::nullopt;
  return offset[0] == '-' ? -size : size;
}

DicomTime to_dicom_time(std::int64_t ns, std::chrono::minutes offset) {
  using namespace std::chrono;
  const auto local = sys_time<nanoseconds>{nanoseconds{ns}} + offset;
  const auto day = floor<days>(local);
  const year_month_day date{day};
  const hh_mm_ss clock{floor<microseconds>(local - day)};
  const auto minutes_away = std::abs(offset.count());
  return {fmt::format("{:04}{:02}{:02}", static_cast<int>(date.year()),
                      static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day())),
          fmt::format("{:02}{:02}{:02}.{:06}", clock.hours().count(), clock.minutes().count(),
                      clock.seconds().count(), clock.subseconds().count()),
          fmt::format("{}{:02}{:02}", offset.count() < 0 ? '-' : '+', minutes_away / 60,
                      minutes_away % 60)};
}

} // namespace octascope::pipeline
