#include "firmware-host/commands/arguments.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <span>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "firmware-host/commands/command.h"
#include "firmware-host/commands/numbers.h"
#include "firmware-host/terminal/terminal.h"
#include "hal/number_text.h"

namespace octascope::firmware_host {

namespace {

// Whole numbers of 1 to `most`, parted by `separator`, as many as `values` holds.
bool parse_counts(std::string_view text, char separator, int most, std::span<int> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) {
      if (!text.starts_with(separator))
        return false;
      text.remove_prefix(1);
    }
    values[i] = hal::take_number<int>(text).value_or(0);
    if (values[i] < 1 || values[i] > most)
      return false;
  }
  return text.empty();
}

const std::map<std::string, DisplayChoice>& displays() {
  static const std::map<std::string, DisplayChoice> all{{"auto", DisplayChoice::automatic},
                                                        {"kms", DisplayChoice::kms},
                                                        {"window", DisplayChoice::window},
                                                        {"offscreen", DisplayChoice::offscreen}};
  return all;
}

// A tree is read while the run goes on, and one that cannot be read is a fault of the run; but a name
// that leads nowhere is a slip of whoever gave it.
hal::Result<> check_there(std::string_view option, const std::string& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (file.empty() || (std::filesystem::exists(status) && !std::filesystem::is_directory(status)))
    return {};
  return hal::fail(hal::ErrorCode::absent, "{} is {}, {}, expected a file", option, file,
                   std::filesystem::exists(status) ? "a folder" : "and there is no such file");
}

} // namespace

void add_show_options(CLI::App& command, ShowArguments& a) {
  command.add_option("--config", a.configuration, "Configuration")->type_name("FILE.toml");
  command.add_option("--display", a.display, "Where the picture goes")
      ->check(CLI::IsMember({"auto", "kms", "window", "offscreen"}))
      ->capture_default_str();
  command.add_option("--size", a.size, "Size of the picture in pixels, as 1280x720")
      ->type_name("WxH");
  auto* duration = command.add_option("--duration", a.duration_s, "End after so many seconds")
                       ->check(within(0.1, 1e9));
  command.add_option("--volumes", a.volumes, "End after so many volumes")
      ->check(within(1, 1000000000))
      ->excludes(duration);
  CLI::Option* vessels =
      command
          .add_option("--vessels", a.vessels,
                      "Vessel tree to show in the volume and, registered, in the flat pictures: "
                      "ours, SWC (in µm) or VTP (in mm)")
          ->type_name("FILE");
  command
      .add_option("--registration", a.registration,
                  "Where it lies in the volume; else in its middle, marked as not registered, or, "
                  "with --flow, where what flows says")
      ->type_name("FILE.toml")
      ->needs(vessels);
  command.add_option("--snapshot", a.snapshot, "Write the last picture here")
      ->type_name("FILE.png");
  command.add_option("--report", a.report, "Write the report here")->type_name("FILE.json");
}

hal::Result<> read_show_options(const ShowArguments& a, RunOptions& options) {
  HAL_CHECK(check_there("--vessels", a.vessels));
  HAL_CHECK(check_there("--registration", a.registration));
  options.configuration = path_of(a.configuration);
  options.display = displays().at(a.display);
  options.vessels = path_of(a.vessels);
  options.registration = path_of(a.registration);
  options.snapshot = path_of(a.snapshot);
  options.report = path_of(a.report);
  if (a.duration_s > 0)
    options.duration_s = a.duration_s;
  if (a.volumes > 0)
    options.volumes = a.volumes;
  if (a.size.empty())
    return {};
  return parse_size(a.size).map([&](const std::array<int, 2>& size) { options.size = size; });
}

std::optional<std::filesystem::path> path_of(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional<std::filesystem::path>{text};
}

int complain(std::string_view command, const hal::Error& error) {
  warn("octascope {}: {}\n", command, error.message);
  return error.code == hal::ErrorCode::invalid_argument ? exit_wrong_use : exit_failed;
}

hal::Result<std::array<int, 2>> parse_size(std::string_view text) {
  std::array<int, 2> size{};
  if (parse_counts(text, 'x', 16384, size))
    return size;
  return hal::fail(
      hal::ErrorCode::invalid_argument,
      "--size is \"{}\", expected width x height in pixels, 1 to 16384 each, as in 1280x720", text);
}

bool read_number(std::string_view text, float& value, const ui::NumberRange& range) {
  const auto number = hal::number_of<float>(text);
  value = number.value_or(0.0F);
  return number && value >= range.lowest && value <= range.highest;
}

hal::Result<ui::DisplayWindow> parse_window(std::string_view text) {
  const ui::NumberRange offset = range_of(ui::Action::window_offset);
  const ui::NumberRange size = range_of(ui::Action::window_size);
  ui::DisplayWindow window;
  const std::size_t comma = text.find(',');
  if (comma != std::string_view::npos &&
      read_number(text.substr(0, comma), window.offset_db, offset) &&
      read_number(text.substr(comma + 1), window.size_db, size))
    return window;
  return hal::fail(hal::ErrorCode::invalid_argument,
                   "--window is \"{}\", expected L,S: the level in dB where it begins ({} to {}) "
                   "and its size in dB ({} to {}), as in 8,36",
                   text, offset.lowest, offset.highest, size.lowest, size.highest);
}

hal::Result<VolumeRange> parse_volumes(std::string_view text) {
  using Number = decltype(VolumeRange::first);
  const std::size_t dash = std::min(text.find('-'), text.size());
  const std::string_view after = text.substr(std::min(dash + 1, text.size()));
  const auto first = hal::number_of<Number>(text.substr(0, dash));
  const auto last = dash == text.size() ? first : hal::number_of<Number>(after);
  if (first && (after.empty() || (last && *last >= *first)))
    return VolumeRange{*first, last};
  return hal::fail(hal::ErrorCode::invalid_argument,
                   "--volumes is \"{}\", expected one volume, counted from 0, or a range, as in "
                   "12, 10-20, or 10- to the last",
                   text);
}

} // namespace octascope::firmware_host
