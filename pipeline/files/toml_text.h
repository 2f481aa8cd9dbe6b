// Formats values as TOML.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace octascope::pipeline {

// A quoted basic string; quotes, backslashes and control characters are escaped.
std::string toml_text(std::string_view text);

// With enough digits that reading gives the same doubles.
std::string toml_numbers(const std::vector<double>& values);

} // namespace octascope::pipeline
