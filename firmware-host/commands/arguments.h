// Arguments that several commands take, from text to value.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "hal/result.h"
#include "ui/auto_window.h"
#include "ui/view_state.h"

namespace octascope::firmware_host {

// "1280x720": width and height, each 1 to 16384.
hal::Result<std::array<int, 2>> parse_size(std::string_view text);

// The whole text as a number of the range; "nan" is in none.
bool read_number(std::string_view text, float& value, const ui::ParameterRange& range);

// "8,36": the level in dB where the display window begins, and its size in dB.
hal::Result<ui::DisplayWindow> parse_window(std::string_view text);

// Of the volumes of a recording, counted from 0.
struct VolumeRange {
  std::size_t first = 0;
  std::optional<std::size_t> last; // empty: the recording's
};

// "12", "10-20", or "10-": to the last.
hal::Result<VolumeRange> parse_volumes(std::string_view text);

} // namespace octascope::firmware_host
