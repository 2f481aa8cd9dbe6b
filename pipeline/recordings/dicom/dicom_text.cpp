#include "pipeline/recordings/dicom/dicom_text.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

namespace octascope::pipeline {

namespace {

constexpr std::size_t longest_long_string = 64;

// The bytes of the character at the beginning; 0 where there is none of UTF-8 (RFC 3629).
std::size_t character_length(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t length = first < 0x80                    ? 1
                             : first >= 0xC2 && first < 0xE0 ? 2
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4
                                                             : 0;
  if (length > text.size())
    return 0;
  for (const char c : text.substr(1, length == 0 ? 0 : length - 1)) {
    if ((static_cast<unsigned char>(c) & 0xC0) != 0x80)
      return 0;
  }
  // Longer than need be, half of a pair, or beyond the last character.
  const auto second = static_cast<unsigned char>(text.size() > 1 ? text[1] : 0);
  const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool no_character = (first == 0xED && second > 0x9F) || (first == 0xF4 && second > 0x8F);
  return overlong || no_character ? 0 : length;
}

bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  return first < 0x20 || first == 0x7F ||
         (first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0);
}

} // namespace

bool is_long_string(std::string_view text) {
  std::size_t characters = 0;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    if (length == 0 || text.front() == '\\' || is_control(text.substr(0, length)))
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
    const std::size_t length = character_length(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
    if (length == 0)
      fitting += '?';
    else if (is_control(character))
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
