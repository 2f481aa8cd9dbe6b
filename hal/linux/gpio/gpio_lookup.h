// Which GPIO lines there are, and which of them is meant: by its name, or as "gpiochip0:17".
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hal/linux/gpio/gpio_line.h"

namespace octascope::hal::linux_backend {

struct GpioSurvey {
  std::vector<GpioChipInfo> chips; // in the order of their numbers
  std::vector<std::string>
      complaints;            // one for each chip that could not be asked: why, and the remedy
  bool udev_at_work = false; // such a chip may be allowed in a moment: absent, not denied
};

// Asks every chip in `dev`; takes no line.
GpioSurvey survey_gpio(const std::filesystem::path& dev = "/dev");

struct GpioLineAddress {
  std::string node; // of the chip
  unsigned offset = 0;
  bool operator==(const GpioLineAddress&) const = default;
};

// A line is never guessed: only a name that exactly one line has, or an explicit chip and offset.
// ErrorCode::absent: there is no such line; denied: nor could a chip be asked that may have it;
// invalid_argument: more than one line has the name. Pure.
Result<GpioLineAddress> find_gpio_line(const GpioSurvey& survey, std::string_view wanted);

// What to do to get `wanted`, given what the survey found: one line for `doctor`; empty if the line
// is there and free. Pure.
std::string gpio_complaint(const GpioSurvey& survey, std::string_view wanted);

} // namespace octascope::hal::linux_backend
