// Values as DICOM writes them: PS3.5, 6.2.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace octascope::pipeline {

// Long String (LO): at most 64 characters of UTF-8, no backslash (it separates values), no control
// characters.
bool is_long_string(std::string_view text);

// Makes a text fit LO, for values that identify nobody: characters that LO cannot hold become
// blanks and slashes, broken UTF-8 becomes question marks; cut to 64 characters.
std::string to_long_string(std::string_view text);

// Decimal String (DS): at most 16 bytes, here nine digits.
std::string to_decimal_string(double value);

// The offset from UTC at the end of an ISO 8601 time: "+01:00", "-03:30", "Z"; empty without one.
std::optional<std::chrono::minutes> offset_from_utc(std::string_view time);

// A moment on the clock of a place: date (DA), time (TM), and the place's offset as Timezone Offset
// From UTC (SH, PS3.3, C.12.1) has it.
struct DicomTime {
  std::string date;   // 20261122
  std::string time;   // 121003.141000
  std::string offset; // +0100

  // Date and time in one (DT).
  std::string date_time() const { return date + time + offset; }
};

// `ns` since 1970, UTC.
DicomTime to_dicom_time(std::int64_t ns, std::chrono::minutes offset);

} // namespace octascope::pipeline
