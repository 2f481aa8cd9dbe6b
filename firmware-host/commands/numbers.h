// Numbers on the command line.
#pragma once

#include <charconv>
#include <string>
#include <system_error>

#include <CLI/App.hpp>
#include <fmt/format.h>

namespace octascope::firmware_host {

// The whole text as a decimal number within [lowest, highest]: so neither nan nor inf, which
// compare as neither too small nor too large, nor CLI11's hexadecimal and octal ones.
template <class Number> CLI::Validator within(Number lowest, Number highest) {
  return CLI::Validator{
      [lowest, highest](std::string& text) {
        Number value{};
        const char* const end = text.data() + text.size();
        const auto [at, error] = std::from_chars(text.data(), end, value);
        if (error == std::errc{} && at == end && value >= lowest && value <= highest) {
          text = fmt::format("{}", value);
          return std::string{};
        }
        return fmt::format("found \"{}\", expected a number from {} to {}", text, lowest, highest);
      },
      fmt::format("{} to {}", lowest, highest)};
}

} // namespace octascope::firmware_host
