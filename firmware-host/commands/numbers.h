// Numbers on the command line.
#pragma once

#include <string>

#include <CLI/App.hpp>
#include <fmt/format.h>

#include "hal/number_text.h"

namespace octascope::firmware_host {

// The whole text as a decimal number within [lowest, highest]: so neither nan nor inf, which
// compare as neither too small nor too large, nor CLI11's hexadecimal and octal ones.
template <class Number> CLI::Validator within(Number lowest, Number highest) {
  return CLI::Validator{[lowest, highest](std::string& text) {
                          const auto value = hal::number_of<Number>(text);
                          if (value && *value >= lowest && *value <= highest) {
                            text = fmt::format("{}", *value);
                            return std::string{};
                          }
                          return fmt::format("found \"{}\", expected a number from {} to {}", text,
                                             lowest, highest);
                        },
                        fmt::format("{} to {}", lowest, highest)};
}

} // namespace octascope::firmware_host
