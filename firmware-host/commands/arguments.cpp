#include "firmware-host/commands/arguments.h"

#include <charconv>
#include <span>

#include <fmt/format.h>

namespace octascope::firmware_host {

namespace {

// Whole numbers of 1 to `most`, parted by `separator`, as many as `values` holds.
bool parse_counts(std::string_view text, char separator, int most, std::span<int> values) {
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0 && (at == end || *at++ != separator))
      return false;
    const auto [next, error] = std::from_chars(at, end, values[i]);
    if (error != std::errc{} || values[i] < 1 || values[i] > most)
      return false;
    at = next;
  }
  return at == end;
}

} // namespace

hal::Result<std::array<int, 2>> parse_size(std::string_view text) {
  std::array<int, 2> size{};
  if (parse_counts(text, 'x', 16384, size))
    return size;
  return hal::fail(hal::Fault::invalid_argument,
                   fmt::format("--size is \"{}\", expected width x height in pixels, 1 to 16384 "
                               "each, as in 1280x720",
                               text));
}

} // namespace octascope::firmware_host
