// Which eye is operated, as given by the user; may be unknown.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace octascope::pipeline {

enum class Eye : std::uint8_t { not_said, left, right };

constexpr std::string_view to_string(Eye eye) {
  switch (eye) {
  case Eye::left: return "left";
  case Eye::right: return "right";
  case Eye::not_said: break;
  }
  return "not said";
}

// Empty for any word other than "left" and "right".
constexpr std::optional<Eye> eye_named(std::string_view word) {
  for (const Eye eye : {Eye::left, Eye::right}) {
    if (to_string(eye) == word)
      return eye;
  }
  return std::nullopt;
}

} // namespace octascope::pipeline
