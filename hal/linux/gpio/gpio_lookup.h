// Lists the GPIO lines and finds one by its name or as "gpiochip0:17".
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hal/linux/gpio/gpio_line.h"

namespace octascope::hal::linux_backend {

struct GpioSurvey {
  std::vector<GpioChipInfo> chips; // by number
  std::vector<std::string>
      complaints;            // one for each chip that could not be queried: reason and remedy
  bool udev_at_work = false; // access to such a chip may be granted soon: absent, not denied
};

// Queries every chip in `dev`; acquires no line.
GpioSurvey survey_gpio(const std::filesystem::path& dev = "/dev");

// For people: "0 octascope-trigger, 1 octascope-sync, 6 without a name". Pure.
std::string listed_lines(const GpioChipInfo& chip);

struct GpioLineAddress {
  std::string node; // of the chip
  unsigned offset = 0;
  bool operator==(const GpioLineAddress&) const = default;
};

// Accepts a name that exactly one line has, or an explicit chip and offset; never guesses.
// ErrorCode::absent: there is no such line; denied: not found, and a chip that may have it could
// not be queried; invalid_argument: more than one line has the name. Pure.
Result<GpioLineAddress> find_gpio_line(const GpioSurvey& survey, std::string_view wanted);

// One line for `doctor`: what to do so that `wanted` can be used; empty if the line exists and is
// free. Pure.
std::string gpio_complaint(const GpioSurvey& survey, std::string_view wanted);

} // namespace octascope::hal::linux_backend
