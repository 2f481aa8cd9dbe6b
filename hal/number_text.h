// Numbers in text from outside: independent of the locale, without blanks in front.
#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <system_error>

namespace octascope::hal {

// Takes a number from the beginning of `text`; empty if there is none or the type cannot hold it.
// Floats may be nan and inf. `base` is for integers; decimal if not given.
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

// The whole text as a number; empty if it is anything else.
template <class Number, class... Base>
std::optional<Number> number_of(std::string_view text, Base... base) {
  const auto number = take_number<Number>(text, base...);
  return text.empty() ? number : std::nullopt;
}

} // namespace octascope::hal
