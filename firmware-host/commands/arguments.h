// Arguments that several commands take, from text to value.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <CLI/App.hpp>

#include "firmware-host/configuration/run_options.h"
#include "hal/result.h"
#include "ui/transfer/auto_window.h"
#include "ui/view/action_table.h"

namespace octascope::firmware_host {

// Options that run, record and replay share, as text, the way CLI11 collects them.
struct ShowArguments {
  std::string configuration, display = "auto", size, vessels, registration, snapshot, report;
  double duration_s = 0;
  std::uint64_t volumes = 0;
};
void add_show_options(CLI::App& command, ShowArguments& arguments);
hal::Result<> read_show_options(const ShowArguments& arguments, RunOptions& options);

// Empty for empty text.
std::optional<std::filesystem::path> path_of(const std::string& text);

// Prints the error and returns the exit status: wrong use for errors in what was asked for, else
// failure.
int complain(std::string_view command, const hal::Error& error);

// "1280x720": width and height, each 1 to 16384.
hal::Result<std::array<int, 2>> parse_size(std::string_view text);

// Parses the whole text as a number within the range; NaN is in no range.
bool read_number(std::string_view text, float& value, const ui::NumberRange& range);

// "8,36": the level in dB where the display window begins, and its size in dB.
hal::Result<ui::DisplayWindow> parse_window(std::string_view text);

// Volumes of a recording, counted from 0.
struct VolumeRange {
  std::size_t first = 0;
  std::optional<std::size_t> last; // empty: the recording's
};

// "12", "10-20", or "10-": to the last.
hal::Result<VolumeRange> parse_volumes(std::string_view text);

} // namespace octascope::firmware_host
