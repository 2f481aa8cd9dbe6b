// Values as they stand in a TOML file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace octascope::pipeline {

// A basic string: quotes, backslashes and control characters are escaped.
std::string toml_text(std::string_view text);

// With all the digits that a double has, so that reading gives the same number.
std::string toml_numbers(const std::vector<double>& values);

} // namespace octascope::pipeline
