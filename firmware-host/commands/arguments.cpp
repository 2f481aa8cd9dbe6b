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

bool read_number(std::string_view text, float& value, const ui::ParameterRange& range) {
  const char* const end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && at == end && value >= range.lowest && value <= range.highest;
}

hal::Result<ui::DisplayWindow> parse_window(std::string_view text) {
  const ui::ParameterRange offset = parameter_range(ui::Parameter::window_offset, 1);
  const ui::ParameterRange size = parameter_range(ui::Parameter::window_size, 1);
  ui::DisplayWindow window;
  const std::size_t comma = text.find(',');
  if (comma != std::string_view::npos &&
      read_number(text.substr(0, comma), window.offset_db, offset) &&
      read_number(text.substr(comma + 1), window.size_db, size))
    return window;
  return hal::fail(hal::Fault::invalid_argument,
                   fmt::format("--window is \"{}\", expected L,S: the level in dB where it begins "
                               "({} to {}) and its size in dB ({} to {}), as in 8,36",
                               text, offset.lowest, offset.highest, size.lowest, size.highest));
}

hal::Result<VolumeRange> parse_volumes(std::string_view text) {
  VolumeRange range;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, range.first);
  if (first.ec == std::errc{} && first.ptr == end)
    range.last = range.first;
  bool good = first.ec == std::errc{} && (first.ptr == end || *first.ptr == '-');
  if (good && first.ptr != end && first.ptr + 1 != end) {
    const auto last = std::from_chars(first.ptr + 1, end, range.last.emplace());
    good = last.ec == std::errc{} && last.ptr == end && *range.last >= range.first;
  }
  if (good)
    return range;
  return hal::fail(hal::Fault::invalid_argument,
                   fmt::format("--volumes is \"{}\", expected one volume, counted from 0, or a "
                               "range, as in 12, 10-20, or 10- to the last",
                               text));
}

} // namespace octascope::firmware_host
