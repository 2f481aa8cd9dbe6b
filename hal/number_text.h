// Numbers in text from outside: decimal, whatever the locale; nothing is skipped before them.
#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <system_error>

namespace octascope::hal {

// The number that `text` begins with, which is taken from it; nothing if there is none, or the type
// cannot hold it. Floats may be nan and inf. `base`: of integers, if not 10.
template <class Number, class... Base>
std::optional<Number> take_number(std::string_view& text, Base... base) {
  Number number{};
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), number, base...);
  if (error != std::errc{})
    return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

// The whole text as a number.
template <class Number, class... Base>
std::optional<Number> number_of(std::string_view text, Base... base) {
  const auto number = take_number<Number>(text, base...);
  return text.empty() ? number : std::nullopt;
}

} // namespace octascope::hal
