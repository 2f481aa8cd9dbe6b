#include "pipeline/files/toml_text.h"

#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace octascope::pipeline {

std::string toml_text(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      result += fmt::format("\\{}", c);
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      result += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      result += c;
  }
  return result + "\"";
}

std::string toml_numbers(const std::vector<double>& values) {
  std::vector<std::string> texts;
  for (const double value : values) {
    std::string text = fmt::format("{:.17g}", value);
    if (text.find_first_of(".e") == std::string::npos)
      text += ".0";
    texts.push_back(std::move(text));
  }
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

} // namespace octascope::pipeline
